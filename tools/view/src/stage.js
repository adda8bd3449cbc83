// The water: camera, and everything that is in it, at one moment. Five draw calls: bodies, boxes, links, wavefronts, and the frame.

import { PerspectiveCamera, Scene, Vector3, WebGLRenderer } from 'three';
import { OrbitControls } from 'three/addons/controls/OrbitControls.js';
import { links, wavefronts } from './moment.js';
import { rgb } from './palette.js';
import { Bodies, Segments, Waves } from './shapes.js';

const LINKS_MAX = 400000;
/** So many links are drawn, evenly chosen among more: long lines cost most. Fewer without a GPU. */
const LINKS_DRAWN_MAX = 24000;
const LINKS_DRAWN_SOFTWARE = 5000;
const WAVES_MAX = 2048;
/** So much of the past of the selected AUV is drawn, in so many boxes. */
const TUBE_S = 20;
const TUBE_BOXES = 10;

/** Seed 001, figure 6.4: (a) positions, (b) links, (c) boxes, (d) pings; bodies are smaller where they would hide what is shown. */
export const PANES = [
  { title: 'True positions', layers: ['bodies'], bodies: 1 },
  { title: 'Links in range', layers: ['bodies', 'links'], bodies: 0.6 },
  { title: 'Localization boxes', layers: ['bodies', 'boxes'], bodies: 0.4 },
  { title: 'Ping wavefronts', layers: ['bodies', 'waves'], bodies: 0.5 },
];

export class Stage {
  constructor(canvas, cast) {
    this.cast = cast;
    const antialias = !isSoftware();
    this.renderer = new WebGLRenderer({ canvas, antialias, alpha: true, powerPreference: 'high-performance' });
    this.renderer.setPixelRatio(antialias ? Math.min(devicePixelRatio, 2) : 1);
    this.renderer.info.autoReset = false;
    this.renderer.setClearAlpha(0);
    this.scene = new Scene();
    this.camera = new PerspectiveCamera(42, 1, 0.1, 1e5);
    this.camera.up.set(0, 0, 1);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.zoomToCursor = true;
    const auvs = cast.names.length;
    this.pairs = new Uint32Array(2 * LINKS_MAX);
    this.bodies = new Bodies(auvs, auvs > 400);
    this.least = auvs > 2000 ? 6 : auvs > 400 ? 9 : auvs > 60 ? 12 : 17;
    this.boxes = new Segments(12 * (auvs + 2 * TUBE_BOXES) + 1300, 2);
    this.linksDrawn = antialias ? LINKS_DRAWN_MAX : LINKS_DRAWN_SOFTWARE;
    this.links = new Segments(this.linksDrawn + auvs, 1);
    this.waves = auvs > 100 ? new Waves(WAVES_MAX, 44) : new Waves(WAVES_MAX / 4, 128);
    this.frame = new Segments(400, 0);
    this.objects = {
      frame: this.frame.object,
      links: this.links.object,
      boxes: this.boxes.object,
      waves: this.waves.object,
      bodies: this.bodies.object,
    };
    this.scene.add(...Object.values(this.objects));
    this.counts = { bodies: 0, links: 0, boxes: 0, waves: 0 };
    this.linked = { t: NaN, found: 0 };
  }

  /** The part of the water that matters: the mission's area, or what the AUVs take up. */
  surround(region) {
    this.region = region;
    const [[x0, x1], [y0, y1], [z0, z1]] = region;
    this.centre = new Vector3((x0 + x1) / 2, (y0 + y1) / 2, (z0 + z1) / 2);
    this.size = Math.hypot(x1 - x0, y1 - y0, z1 - z0) || 10;
    this.camera.near = this.size / 2000;
    this.camera.far = this.size * 20;
    this.home();
  }

  home() {
    const { clientWidth: width, clientHeight: height } = this.renderer.domElement.parentElement;
    const { camera, controls, centre } = this;
    camera.aspect = width / Math.max(1, height);
    camera.updateProjectionMatrix();
    const away = new Vector3(-0.5, -1, 0.42).normalize();
    controls.target.copy(centre);
    // As near as all corners allow.
    let [near, far] = [0.3 * this.size, 8 * this.size];
    for (let step = 0; step < 24; step++) {
      const middle = (near + far) / 2;
      camera.position.copy(centre).addScaledVector(away, middle);
      camera.lookAt(centre);
      camera.updateMatrixWorld();
      if (this.corners().every((corner) => this.isInside(corner))) far = middle;
      else near = middle;
    }
    camera.position.copy(centre).addScaledVector(away, far);
    controls.update();
  }

  corners() {
    const [x, y, z] = this.region;
    return x.flatMap((i) => y.flatMap((j) => z.map((k) => new Vector3(i, j, k))));
  }

  isInside(place) {
    const { x, y, z } = place.project(this.camera);
    return Math.abs(x) < 0.94 && Math.abs(y) < 0.92 && z < 1;
  }

  /** Looks at one AUV from near by. */
  approach(x, y, z, distance) {
    const target = new Vector3(x, y, z);
    const away = this.camera.position.clone().sub(this.controls.target).setLength(distance);
    this.controls.target.copy(target);
    this.camera.position.copy(target).add(away);
    this.controls.update();
  }

  /** Moves with an AUV. */
  follow(x, y, z) {
    const step = new Vector3(x, y, z).sub(this.controls.target);
    this.controls.target.add(step);
    this.camera.position.add(step);
  }

  paint({ dark, colours, line }) {
    this.dark = dark;
    this.colours = colours.map(rgb);
    this.line = rgb(line);
    this.bodies.uniforms.shade.value = dark ? 0.45 : 0.62;
    this.waves.glow(dark);
    this.drawFrame();
  }

  /** The edges of the area, and a grid on the surface of the sea. */
  drawFrame() {
    const [[x0, x1], [y0, y1], [z0, z1]] = this.region;
    const { frame } = this;
    frame.clear();
    const [r, g, b] = this.line;
    frame.box([x0, x1, y0, y1, z0, z1], 0, r, g, b, this.dark ? 120 : 150);
    const cells = 10;
    for (let step = 1; step < cells; step++) {
      const [x, y] = [x0 + ((x1 - x0) * step) / cells, y0 + ((y1 - y0) * step) / cells];
      for (const [z, alpha] of [[z1, this.dark ? 42 : 70], [z0, this.dark ? 26 : 40]]) {
        frame.add(x, y0, z, x, y1, z, r, g, b, alpha);
        frame.add(x0, y, z, x1, y, z, r, g, b, alpha);
      }
    }
    frame.show();
  }

  /** Fills everything for the moment; `view` says what is visible and selected. */
  fill(moment, film, view) {
    const { cast, colours } = this;
    const { shown, position, heading, pitch, box } = moment;
    const { visible, selected, layers, glow, track } = view;
    const dimmed = selected >= 0 && cast.names.length > 8;
    this.boxes.clear();
    this.bodies.count = 0;
    let boxed = 0;
    for (let auv = 0; auv < moment.auvs; auv++) {
      if (!shown[auv] || !visible[auv]) continue;
      const [r, g, b] = colours[cast.groupOf[auv]];
      const own = auv === selected;
      const length = own ? -cast.length[auv] : cast.length[auv];
      this.bodies.put(position[3 * auv], position[3 * auv + 1], position[3 * auv + 2], length, heading[auv], pitch[auv], r, g, b);
      if (!layers.boxes && !own) continue;
      if (Number.isNaN(box[6 * auv])) continue;
      boxed++;
      if (moment.holds[auv]) this.boxes.box(box, 6 * auv, r, g, b, own ? 255 : dimmed ? 90 : this.dark ? 165 : 185);
      else this.boxes.box(box, 6 * auv, 255, 40, 90, 255);
    }
    this.bodies.show();
    if (track) this.addTube(track, moment, colours[cast.groupOf[track.auv]]);
    this.boxes.show();
    this.fillLinks(moment, film, view);
    this.waves.count = 0;
    if (layers.waves) {
      const crowd = Math.min(1, Math.max(0.3, 150 / Math.max(1, this.counts.waves)));
      wavefronts(film, moment.t, cast, glow, (x, y, z, radius, from, strength) => {
        if (!visible[from]) return;
        const [r, g, b] = colours[cast.groupOf[from]];
        const alpha = from === selected ? strength : strength * crowd * (dimmed ? 0.5 : this.dark ? 0.9 : 0.8);
        this.waves.put(x, y, z, radius, r, g, b, alpha);
      });
    }
    this.waves.show();
    Object.assign(this.counts, { bodies: this.bodies.count, boxes: boxed, waves: this.waves.count });
    this.layers = layers;
  }

  fillLinks(moment, film, { visible, selected, layers, version }) {
    const { links: lines, linked, pairs } = this;
    lines.clear();
    if (layers.links) {
      // Who is in range of whom changes slowly.
      if (!(Math.abs(moment.t - linked.t) < 0.1) || linked.version !== version) {
        linked.found = links(moment, this.cast, film, visible, pairs);
        linked.t = moment.t;
        linked.version = version;
      }
      const there = Math.min(linked.found, LINKS_MAX);
      const stride = Math.max(1, Math.ceil(there / this.linksDrawn));
      const [r, g, b] = this.line;
      const one = this.colours[this.cast.groupOf[selected]];
      const alpha = Math.max(this.dark ? 16 : 22, Math.min(150, 60000 / Math.max(1, there / stride))) * (one ? 0.5 : 1);
      const { position } = moment;
      const add = (from, to, red, green, blue, strength) => {
        const [i, j] = [3 * from, 3 * to];
        lines.add(position[i], position[i + 1], position[i + 2], position[j], position[j + 1], position[j + 2], red, green, blue, strength);
      };
      for (let pair = 0; pair < there; pair++) {
        const [from, to] = [pairs[2 * pair], pairs[2 * pair + 1]];
        if (from === selected || to === selected) add(from, to, one[0], one[1], one[2], 230);
        else if (pair % stride === 0) add(from, to, r, g, b, alpha);
      }
      this.counts.linksDrawn = stride;
      this.counts.links = linked.found;
    } else {
      this.counts.links = 0;
      linked.t = NaN;
    }
    lines.show();
  }

  /** What the selected AUV knew of its way lately, and its true way; the older the fainter. */
  addTube(track, { t }, [r, g, b]) {
    const age = (row) => (t - track.rows[row].t) / TUBE_S;
    const last = track.at(t);
    const first = track.at(t - TUBE_S) + 1;
    const step = Math.max(1, Math.ceil((last - first) / TUBE_BOXES));
    for (let row = last - (last % step); row >= first; row -= step) {
      this.boxes.box(track.rows[row].box, 0, r, g, b, (this.dark ? 120 : 150) * (1 - age(row)));
    }
    const stride = Math.max(1, Math.ceil((last - first) / 600));
    const [red, green, blue] = this.dark ? [255, 255, 255] : [10, 20, 30];
    for (let row = last - (last % stride); row >= Math.max(first, stride); row -= stride) {
      const [one, other] = [track.rows[row - stride].position, track.rows[row].position];
      this.boxes.add(...one, ...other, red, green, blue, 230 * (1 - age(row)));
    }
  }

  /** Draws one picture, or four side by side. */
  draw(width, height, panes) {
    const { renderer, camera, objects } = this;
    if (this.width !== width || this.height !== height) {
      renderer.setSize(width, height, false);
      [this.width, this.height] = [width, height];
    }
    renderer.info.reset();
    const [across, down] = panes ? [width / 2, height / 2] : [width, height];
    camera.aspect = across / down;
    camera.updateProjectionMatrix();
    // What a pixel is at distance 1.
    const pixel = (2 * Math.tan((camera.fov * Math.PI) / 360)) / down;
    this.bodies.uniforms.pixel.value = pixel;
    this.waves.uniforms.pixel.value = pixel;
    renderer.setScissorTest(true);
    const lit = Object.fromEntries(Object.entries(objects).map(([name, object]) => [name, object.visible]));
    for (const [index, pane] of (panes ? PANES : [{ layers: null, bodies: 1 }]).entries()) {
      const [left, top] = panes ? [(index % 2) * across, Math.floor(index / 2) * down] : [0, 0];
      this.bodies.uniforms.least.value = this.least * pane.bodies;
      renderer.setViewport(left, height - top - down, across, down);
      renderer.setScissor(left, height - top - down, across, down);
      for (const [name, object] of Object.entries(objects)) {
        const wanted = pane.layers ? name === 'frame' || pane.layers.includes(name) : name !== 'bodies' || this.layers.bodies;
        object.visible = lit[name] && wanted;
      }
      renderer.render(this.scene, camera);
    }
    for (const [name, object] of Object.entries(objects)) object.visible = lit[name];
  }

  /** Where a place is in the picture, in pixels from the top left; `null` behind the camera. */
  project(x, y, z, width, height) {
    const at = new Vector3(x, y, z).project(this.camera);
    return at.z > 1 || at.z < -1 ? null : [((at.x + 1) / 2) * width, ((1 - at.y) / 2) * height];
  }
}

/** Whether pictures are made without a GPU. */
function isSoftware() {
  const gl = document.createElement('canvas').getContext('webgl2');
  const info = gl?.getExtension('WEBGL_debug_renderer_info');
  const name = info ? gl.getParameter(info.UNMASKED_RENDERER_WEBGL) : '';
  gl?.getExtension('WEBGL_lose_context')?.loseContext();
  return /swiftshader|llvmpipe|software/i.test(name);
}
