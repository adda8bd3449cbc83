// The few geometries that a view is made of. Each is drawn in one call.

import {
  AdditiveBlending, BufferAttribute, BufferGeometry, Color, DynamicDrawUsage, InstancedBufferAttribute, InstancedBufferGeometry,
  LineSegments, Mesh, NormalBlending, ShaderMaterial,
} from 'three';

const LINE_VERTEX = `
  attribute vec4 tint;
  varying vec4 vTint;
  void main() {
    vTint = tint;
    gl_Position = projectionMatrix * viewMatrix * vec4(position, 1.0);
  }`;

const LINE_FRAGMENT = `
  varying vec4 vTint;
  void main() { gl_FragColor = vTint; }`;

/** Many line segments with a colour each, filled anew for every picture. */
export class Segments {
  constructor(segments, renderOrder) {
    this.limit = segments;
    this.points = new Float32Array(6 * segments);
    this.tints = new Uint8Array(8 * segments);
    const geometry = new BufferGeometry();
    this.position = new BufferAttribute(this.points, 3).setUsage(DynamicDrawUsage);
    this.tint = new BufferAttribute(this.tints, 4, true).setUsage(DynamicDrawUsage);
    geometry.setAttribute('position', this.position);
    geometry.setAttribute('tint', this.tint);
    const material = new ShaderMaterial({
      vertexShader: LINE_VERTEX, fragmentShader: LINE_FRAGMENT, transparent: true, depthWrite: false,
    });
    this.object = new LineSegments(geometry, material);
    this.object.frustumCulled = false;
    this.object.renderOrder = renderOrder;
    this.count = 0;
  }

  clear() {
    this.count = 0;
  }

  add(ax, ay, az, bx, by, bz, r, g, b, a) {
    if (this.count >= this.limit) return;
    const { points, tints } = this;
    let at = 6 * this.count;
    points[at++] = ax;
    points[at++] = ay;
    points[at++] = az;
    points[at++] = bx;
    points[at++] = by;
    points[at] = bz;
    at = 8 * this.count;
    for (let end = 0; end < 2; end++) {
      tints[at++] = r;
      tints[at++] = g;
      tints[at++] = b;
      tints[at++] = a;
    }
    this.count++;
  }

  /** The twelve edges of the box from `of[at]` on: lower and upper end of x, y and z. */
  box(of, at, r, g, b, a) {
    const [x0, x1, y0, y1, z0, z1] = [of[at], of[at + 1], of[at + 2], of[at + 3], of[at + 4], of[at + 5]];
    if (!(Math.abs(x1 - x0 + y1 - y0 + z1 - z0) < 1e9)) return;
    for (let i = 0; i < 2; i++) {
      for (let j = 0; j < 2; j++) {
        const [x, y] = [i ? x1 : x0, j ? y1 : y0];
        this.add(x, y, z0, x, y, z1, r, g, b, a);
        const z = j ? z1 : z0;
        this.add(x, y0, z, x, y1, z, r, g, b, a);
        const y2 = i ? y1 : y0;
        this.add(x0, y2, z, x1, y2, z, r, g, b, a);
      }
    }
  }

  show() {
    this.object.geometry.setDrawRange(0, 2 * this.count);
    this.object.visible = this.count > 0;
    if (this.count === 0) return;
    this.position.clearUpdateRanges();
    this.position.addUpdateRange(0, 6 * this.count);
    this.tint.clearUpdateRanges();
    this.tint.addUpdateRange(0, 8 * this.count);
    this.position.needsUpdate = true;
    this.tint.needsUpdate = true;
  }
}

const BODY_VERTEX = `
  attribute vec4 place;
  attribute vec2 course;
  attribute vec4 tint;
  uniform float pixel, least;
  varying vec4 vTint;
  varying vec3 vNormal;
  void main() {
    vec4 centre = viewMatrix * vec4(place.xyz, 1.0);
    float size = max(abs(place.w), least * pixel * -centre.z) * (place.w < 0.0 ? 1.7 : 1.0);
    float h = course.x, p = course.y;
    mat3 turn = mat3(cos(h) * cos(p), sin(h) * cos(p), sin(p), -sin(h), cos(h), 0.0, -cos(h) * sin(p), -sin(h) * sin(p), cos(p));
    vTint = tint;
    vNormal = turn * normal;
    gl_Position = projectionMatrix * viewMatrix * vec4(place.xyz + turn * position * size, 1.0);
  }`;

const BODY_FRAGMENT = `
  varying vec4 vTint;
  varying vec3 vNormal;
  uniform float shade;
  void main() {
    float light = mix(shade, 1.0, 0.5 + 0.5 * dot(normalize(vNormal), normalize(vec3(0.3, -0.4, 0.87))));
    gl_FragColor = vec4(vTint.rgb * light, vTint.a);
  }`;

/** AUVs: hulls that point where they head, never smaller than `least` pixels. */
export class Bodies {
  constructor(auvs) {
    const geometry = new InstancedBufferGeometry();
    const hull = torpedo();
    geometry.setAttribute('position', new BufferAttribute(hull.points, 3));
    geometry.setAttribute('normal', new BufferAttribute(hull.normals, 3));
    geometry.setIndex(hull.index);
    const attribute = (size) => new InstancedBufferAttribute(new Float32Array(size * auvs), size).setUsage(DynamicDrawUsage);
    [this.place, this.course] = [attribute(4), attribute(2)];
    this.tint = new InstancedBufferAttribute(new Uint8Array(4 * auvs), 4, true).setUsage(DynamicDrawUsage);
    geometry.setAttribute('place', this.place);
    geometry.setAttribute('course', this.course);
    geometry.setAttribute('tint', this.tint);
    this.uniforms = { pixel: { value: 1 }, least: { value: 11 }, shade: { value: 0.4 } };
    const material = new ShaderMaterial({
      vertexShader: BODY_VERTEX, fragmentShader: BODY_FRAGMENT, uniforms: this.uniforms, transparent: true,
    });
    this.object = new Mesh(geometry, material);
    this.object.frustumCulled = false;
    this.object.renderOrder = 4;
  }

  show(count) {
    this.object.geometry.instanceCount = count;
    this.object.visible = count > 0;
    for (const attribute of [this.place, this.course, this.tint]) attribute.needsUpdate = true;
  }
}

/** A hull of length 1 along x: a lathe of a profile, with a fin at the stern. */
function torpedo() {
  const profile = [[0.5, 0], [0.43, 0.07], [0.28, 0.11], [-0.2, 0.11], [-0.42, 0.045], [-0.5, 0.02]];
  const sides = 6;
  const [points, normals, index] = [[], [], []];
  profile.forEach(([x, radius], ring) => {
    for (let side = 0; side < sides; side++) {
      const angle = (2 * Math.PI * side) / sides;
      points.push(x, radius * Math.cos(angle), radius * Math.sin(angle));
      const lean = ring === 0 ? 1 : ring > 3 ? -0.4 : 0.25;
      normals.push(lean, Math.cos(angle), Math.sin(angle));
      if (ring === 0) continue;
      const [a, b] = [(ring - 1) * sides + side, (ring - 1) * sides + ((side + 1) % sides)];
      index.push(a, a + sides, b, b, a + sides, b + sides);
    }
  });
  for (const [y, z] of [[1, 0], [0, 1]]) {
    for (const sign of [1, -1]) {
      const first = points.length / 3;
      points.push(-0.34, 0, 0, -0.52, 0.2 * y * sign, 0.2 * z * sign, -0.52, 0, 0);
      for (let corner = 0; corner < 3; corner++) normals.push(0, z, y);
      index.push(first, first + 1, first + 2, first, first + 2, first + 1);
    }
  }
  return { points: new Float32Array(points), normals: new Float32Array(normals), index };
}

const WAVE_VERTEX = `
  attribute vec4 place;
  attribute vec4 tint;
  uniform float pixel;
  varying vec4 vTint;
  varying float vAcross;
  void main() {
    vec4 centre = viewMatrix * vec4(place.xyz, 1.0);
    float thick = 2.2 * pixel * -centre.z;
    float radius = place.w + (position.z - 0.5) * min(thick, place.w + thick);
    vTint = tint;
    vAcross = position.z;
    gl_Position = projectionMatrix * (centre + vec4(position.xy * radius, 0.0, 0.0));
  }`;

const WAVE_FRAGMENT = `
  varying vec4 vTint;
  varying float vAcross;
  void main() { gl_FragColor = vec4(vTint.rgb, vTint.a * (1.0 - abs(2.0 * vAcross - 1.0) * 0.8)); }`;

/** Wavefronts: the outlines of growing spheres. */
export class Waves {
  constructor(limit) {
    this.limit = limit;
    const sides = 56;
    const [points, index] = [[], []];
    for (let side = 0; side < sides; side++) {
      const angle = (2 * Math.PI * side) / sides;
      for (let edge = 0; edge < 2; edge++) points.push(Math.cos(angle), Math.sin(angle), edge);
      const [a, b] = [2 * side, 2 * ((side + 1) % sides)];
      index.push(a, b, a + 1, a + 1, b, b + 1);
    }
    const geometry = new InstancedBufferGeometry();
    geometry.setAttribute('position', new BufferAttribute(new Float32Array(points), 3));
    geometry.setIndex(index);
    this.place = new InstancedBufferAttribute(new Float32Array(4 * limit), 4).setUsage(DynamicDrawUsage);
    this.tint = new InstancedBufferAttribute(new Uint8Array(4 * limit), 4, true).setUsage(DynamicDrawUsage);
    geometry.setAttribute('place', this.place);
    geometry.setAttribute('tint', this.tint);
    this.uniforms = { pixel: { value: 1 } };
    this.material = new ShaderMaterial({
      vertexShader: WAVE_VERTEX, fragmentShader: WAVE_FRAGMENT, uniforms: this.uniforms, transparent: true, depthWrite: false,
    });
    this.object = new Mesh(geometry, this.material);
    this.object.frustumCulled = false;
    this.object.renderOrder = 3;
    this.count = 0;
  }

  glow(dark) {
    this.material.blending = dark ? AdditiveBlending : NormalBlending;
  }

  add(x, y, z, radius, r, g, b, a) {
    if (this.count >= this.limit) return;
    this.place.array.set([x, y, z, radius], 4 * this.count);
    this.tint.array.set([r, g, b, a], 4 * this.count);
    this.count++;
  }

  show() {
    this.object.geometry.instanceCount = this.count;
    this.object.visible = this.count > 0;
    this.place.needsUpdate = true;
    this.tint.needsUpdate = true;
  }
}

export { Color };
