// The few geometries that a view is made of. Each is drawn in one call.

import {
  AdditiveBlending, BufferAttribute, BufferGeometry, DataTexture, DoubleSide, DynamicDrawUsage, FloatType, LineSegments, Mesh,
  NormalBlending, RGBAFormat, ShaderMaterial,
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

/**
 * One shape drawn many times in one call: each copy reads where it is from a texture. Instancing proper would do the same, but
 * without a GPU it costs as much for each copy as a call.
 */
class Copies {
  /** `shape` has points and normals (three numbers a corner) and an index; a copy is eight numbers. */
  constructor(copies, { points, normals, index }, vertexShader, fragmentShader, options) {
    const corners = points.length / 3;
    const all = { position: new Float32Array(3 * corners * copies), normal: new Float32Array(3 * corners * copies) };
    const of = new Float32Array(corners * copies);
    const indices = new Uint32Array(index.length * copies);
    for (let copy = 0; copy < copies; copy++) {
      all.position.set(points, 3 * corners * copy);
      all.normal.set(normals, 3 * corners * copy);
      of.fill(copy, corners * copy, corners * (copy + 1));
      for (let at = 0; at < index.length; at++) indices[copy * index.length + at] = index[at] + corners * copy;
    }
    const geometry = new BufferGeometry();
    geometry.setAttribute('position', new BufferAttribute(all.position, 3));
    geometry.setAttribute('normal', new BufferAttribute(all.normal, 3));
    geometry.setAttribute('copy', new BufferAttribute(of, 1));
    geometry.setIndex(new BufferAttribute(indices, 1));
    this.rows = Math.max(1, Math.ceil((2 * copies) / WIDE));
    this.data = new Float32Array(4 * WIDE * this.rows);
    this.texture = new DataTexture(this.data, WIDE, this.rows, RGBAFormat, FloatType);
    this.uniforms = { pixel: { value: 1 }, copies: { value: this.texture }, ...options.uniforms };
    this.material = new ShaderMaterial({
      vertexShader: COPY + vertexShader, fragmentShader, uniforms: this.uniforms, transparent: true, side: DoubleSide, ...options.material,
    });
    this.object = new Mesh(geometry, this.material);
    this.object.frustumCulled = false;
    this.object.renderOrder = options.renderOrder;
    this.limit = copies;
    this.each = index.length;
    this.count = 0;
  }

  /** Adds a copy: eight numbers, whatever the shader makes of them; the colour as one. */
  add(a, b, c, d, e, f, red, green, blue, h) {
    if (this.count >= this.limit) return;
    const { data } = this;
    const at = 8 * this.count++;
    data[at] = a;
    data[at + 1] = b;
    data[at + 2] = c;
    data[at + 3] = d;
    data[at + 4] = e;
    data[at + 5] = f;
    data[at + 6] = red * 65536 + green * 256 + blue;
    data[at + 7] = h;
  }

  show() {
    this.object.geometry.setDrawRange(0, this.count * this.each);
    this.object.visible = this.count > 0;
    this.texture.needsUpdate = true;
  }
}

const WIDE = 256;

const COPY = `
  attribute float copy;
  uniform highp sampler2D copies;
  vec4 part(int which) {
    int at = 2 * int(copy) + which;
    return texelFetch(copies, ivec2(at % 256, at / 256), 0);
  }
  vec3 colour(float packed) {
    return vec3(floor(packed / 65536.0), mod(floor(packed / 256.0), 256.0), mod(packed, 256.0)) / 255.0;
  }`;

const BODY_VERTEX = `
  uniform float pixel, least;
  varying vec3 vTint;
  varying vec3 vNormal;
  void main() {
    vec4 place = part(0), more = part(1);
    vec4 centre = viewMatrix * vec4(place.xyz, 1.0);
    float size = max(abs(place.w), least * pixel * -centre.z) * (place.w < 0.0 ? 1.7 : 1.0);
    float h = more.x, p = more.y;
    mat3 turn = mat3(cos(h) * cos(p), sin(h) * cos(p), sin(p), -sin(h), cos(h), 0.0, -cos(h) * sin(p), -sin(h) * sin(p), cos(p));
    vTint = colour(more.z);
    vNormal = turn * normal;
    gl_Position = projectionMatrix * viewMatrix * vec4(place.xyz + turn * position * size, 1.0);
  }`;

const BODY_FRAGMENT = `
  varying vec3 vTint;
  varying vec3 vNormal;
  uniform float shade;
  void main() {
    float light = mix(shade, 1.0, 0.5 + 0.5 * dot(normalize(vNormal), normalize(vec3(0.3, -0.4, 0.87))));
    gl_FragColor = vec4(vTint * light, 1.0);
  }`;

const HULL = [[0.5, 0], [0.43, 0.07], [0.28, 0.11], [-0.2, 0.11], [-0.42, 0.045], [-0.5, 0.02]];
const PLAIN_HULL = [[0.5, 0], [0.25, 0.12], [-0.5, 0.05]];

/** AUVs: hulls that point where they head, never smaller than `least` pixels. */
export class Bodies extends Copies {
  /** `plain` for so many that nobody sees more than a direction. */
  constructor(auvs, plain) {
    const shape = plain ? torpedo(PLAIN_HULL, 4) : torpedo(HULL, 7);
    super(auvs, shape, BODY_VERTEX, BODY_FRAGMENT, { uniforms: { least: { value: 11 }, shade: { value: 0.4 } }, renderOrder: 4 });
  }

  /** `length` is negative for one that stands out. */
  put(x, y, z, length, heading, pitch, red, green, blue) {
    this.add(x, y, z, length, heading, pitch, red, green, blue, 0);
  }
}

/** A hull of length 1 along x: a profile turned around it, with fins at the stern. */
function torpedo(profile, sides) {
  const [points, normals, index] = [[], [], []];
  profile.forEach(([x, radius], ring) => {
    for (let side = 0; side < sides; side++) {
      const angle = (2 * Math.PI * side) / sides;
      points.push(x, radius * Math.cos(angle), radius * Math.sin(angle));
      const lean = ring === 0 ? 1 : x < -0.3 ? -0.4 : 0.25;
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
      index.push(first, first + 1, first + 2);
    }
  }
  return { points, normals, index };
}

const WAVE_VERTEX = `
  uniform float pixel;
  varying vec4 vTint;
  varying float vAcross;
  void main() {
    vec4 place = part(0), more = part(1);
    vec4 centre = viewMatrix * vec4(place.xyz, 1.0);
    float thick = 2.0 * pixel * -centre.z;
    float radius = place.w + (position.z - 0.5) * min(thick, place.w + thick);
    vTint = vec4(colour(more.z), more.w);
    vAcross = position.z;
    gl_Position = projectionMatrix * (centre + vec4(position.xy * radius, 0.0, 0.0));
  }`;

const WAVE_FRAGMENT = `
  varying vec4 vTint;
  varying float vAcross;
  void main() { gl_FragColor = vec4(vTint.rgb, vTint.a * (1.0 - abs(2.0 * vAcross - 1.0) * 0.8)); }`;

/** Wavefronts: the outlines of growing spheres. */
export class Waves extends Copies {
  constructor(limit, sides) {
    super(limit, circle(sides), WAVE_VERTEX, WAVE_FRAGMENT, { renderOrder: 3, material: { depthWrite: false } });
  }

  glow(dark) {
    this.material.blending = dark ? AdditiveBlending : NormalBlending;
  }

  put(x, y, z, radius, red, green, blue, strength) {
    this.add(x, y, z, radius, 0, 0, red, green, blue, strength);
  }
}

/** A ribbon around the unit circle; z is 0 at its inner edge and 1 at its outer one. */
function circle(sides) {
  const [points, index] = [[], []];
  for (let side = 0; side < sides; side++) {
    const angle = (2 * Math.PI * side) / sides;
    for (let edge = 0; edge < 2; edge++) points.push(Math.cos(angle), Math.sin(angle), edge);
    const [a, b] = [2 * side, 2 * ((side + 1) % sides)];
    index.push(a, b, a + 1, a + 1, b, b + 1);
  }
  return { points, normals: points, index };
}
