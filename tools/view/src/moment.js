// The state of all AUVs at one moment, between their ticks: the truth and the box are interpolated alike, so that a box that holds
// the truth at both ticks holds it in between.

import { ANSWERED, HOLDS } from './decode.js';

export class Moment {
  constructor(auvs) {
    this.auvs = auvs;
    this.t = 0;
    this.shown = new Uint8Array(auvs);
    this.holds = new Uint8Array(auvs);
    this.position = new Float32Array(3 * auvs);
    this.heading = new Float32Array(auvs);
    this.pitch = new Float32Array(auvs);
    this.box = new Float32Array(6 * auvs).fill(NaN);
    this.clock = new Float32Array(auvs).fill(NaN);
  }

  /** Goes to `t`; false when the film does not have it yet. */
  go(film, t) {
    const here = film.get(Math.floor(t));
    if (!here) return false;
    const next = film.get(Math.floor(t) + 1);
    this.t = t;
    for (let auv = 0; auv < this.auvs; auv++) this.place(auv, here, next, t);
    return true;
  }

  place(auv, here, next, t) {
    const [begin, end] = [here.begin[auv], here.begin[auv + 1]];
    this.shown[auv] = end > begin ? 1 : 0;
    if (end === begin) return;
    let row = begin;
    const within = t - here.second;
    if (end - begin > 24) {
      let high = end;
      while (high - row > 1) {
        const middle = (row + high) >> 1;
        if (here.t[middle] <= within) row = middle;
        else high = middle;
      }
    } else {
      while (row + 1 < end && here.t[row + 1] <= within) row++;
    }
    let [to, other] = [here, row + 1];
    if (other >= end) {
      to = next;
      other = next ? next.begin[auv] : 0;
      const limit = next ? next.begin[auv + 1] : 0;
      const now = here.second + here.t[row];
      while (to && other < limit && to.second + to.t[other] <= now + 1e-6) other++;
      if (other >= limit) to = null;
    }
    const from = here.second + here.t[row];
    let part = 0;
    if (to) part = Math.min(Math.max((t - from) / (to.second + to.t[other] - from), 0), 1);
    else [to, other] = [here, row];
    const mix = (one, two) => one + (two - one) * part;
    this.position[3 * auv] = mix(here.x[row], to.x[other]);
    this.position[3 * auv + 1] = mix(here.y[row], to.y[other]);
    this.position[3 * auv + 2] = mix(here.z[row], to.z[other]);
    const turn = to.heading[other] - here.heading[row];
    this.heading[auv] = here.heading[row] + part * (turn - 2 * Math.PI * Math.round(turn / (2 * Math.PI)));
    this.pitch[auv] = mix(here.pitch[row], to.pitch[other]);
    // At its last tick an AUV has not answered yet.
    const answered = !Number.isNaN(to.box[0][other]);
    for (let side = 0; side < 6; side++) {
      this.box[6 * auv + side] = answered ? mix(here.box[side][row], to.box[side][other]) : here.box[side][row];
    }
    this.clock[auv] = here.clock[row];
    this.holds[auv] = (here.flags[row] & (ANSWERED | HOLDS)) === ANSWERED ? 0 : 1;
  }

  /** The longest side of an AUV's box. */
  width(auv) {
    const at = 6 * auv;
    const box = this.box;
    return Math.max(box[at + 1] - box[at], box[at + 3] - box[at + 2], box[at + 5] - box[at + 4]);
  }
}

/** Pairs in range of each other, or that heard each other lately: [a, b, a, b, ...] into `pairs`; how many there are. */
export function links(moment, cast, film, visible, pairs) {
  return cast.ideal ? inRange(moment, cast, visible, pairs) : lately(moment, cast, film, visible, pairs);
}

function inRange({ auvs, position, shown }, { reach }, visible, pairs) {
  const cell = Math.max(1e-3, reach.reduce((one, other) => Math.max(one, other), 0));
  const cells = new Map();
  const at = (value) => Math.floor(value / cell) + 524288;
  const key = (x, y, z) => (x * 1048576 + y) * 2048 + (z & 2047);
  for (let auv = 0; auv < auvs; auv++) {
    if (!shown[auv] || !visible[auv]) continue;
    const name = key(at(position[3 * auv]), at(position[3 * auv + 1]), at(position[3 * auv + 2]));
    const others = cells.get(name);
    if (others) others.push(auv);
    else cells.set(name, [auv]);
  }
  let found = 0;
  for (let auv = 0; auv < auvs; auv++) {
    if (!shown[auv] || !visible[auv]) continue;
    const [x, y, z] = [position[3 * auv], position[3 * auv + 1], position[3 * auv + 2]];
    for (let i = -1; i <= 1; i++) {
      for (let j = -1; j <= 1; j++) {
        for (let k = -1; k <= 1; k++) {
          const others = cells.get(key(at(x) + i, at(y) + j, at(z) + k));
          if (!others) continue;
          for (const other of others) {
            if (other <= auv) continue;
            const range = Math.max(reach[auv], reach[other]);
            const [dx, dy, dz] = [position[3 * other] - x, position[3 * other + 1] - y, position[3 * other + 2] - z];
            if (dx * dx + dy * dy + dz * dz > range * range) continue;
            if (2 * found + 1 < pairs.length) [pairs[2 * found], pairs[2 * found + 1]] = [auv, other];
            found++;
          }
        }
      }
    }
  }
  return found;
}

/** Seconds for which a ping that was heard is a link, where ranges are not sharp: until the next one is due. */
export function memoryOf({ groups }) {
  return Math.min(60, 1.2 * Math.max(1, ...groups.map(({ ping_period_s }) => ping_period_s ?? 0)));
}

function lately({ t, shown }, { groupOf, groups }, film, visible, pairs) {
  let found = 0;
  const taken = new Set();
  const longest = memoryOf({ groups });
  for (let second = Math.floor(t); second >= Math.floor(t - longest); second--) {
    const { heard } = film.get(second) ?? {};
    for (let index = 0; heard && index < heard.count; index++) {
      const [from, to, at] = [heard.from[index], heard.to[index], second + heard.t[index]];
      const memory = 1.2 * (groups[groupOf[from]]?.ping_period_s ?? 1);
      if (at > t || at < t - memory || !shown[from] || !shown[to] || !visible[from] || !visible[to]) continue;
      const name = from < to ? from * 1048576 + to : to * 1048576 + from;
      if (taken.has(name)) continue;
      taken.add(name);
      if (2 * found + 1 < pairs.length) [pairs[2 * found], pairs[2 * found + 1]] = [from, to];
      found++;
    }
  }
  return found;
}

/** Wavefronts under way at `t`: calls `visit(x, y, z, radius, emitter, faded)` for each, with `glow` seconds of fading at the end. */
export function wavefronts(film, t, cast, glow, visit) {
  const { soundSpeed, reach, reachMax } = cast;
  const oldest = t - reachMax / soundSpeed - glow;
  for (let second = Math.floor(t); second >= Math.floor(oldest) && second >= 0; second--) {
    const { pings, second: held } = film.get(second) ?? {};
    if (!pings || held !== second) continue;
    for (let index = 0; index < pings.count; index++) {
      const age = t - second - pings.t[index];
      const end = reach[pings.from[index]];
      if (age < 0 || age > end / soundSpeed + glow) continue;
      const radius = Math.min(age * soundSpeed, end);
      const over = Math.max(0, age - end / soundSpeed) / glow;
      visit(pings.x[index], pings.y[index], pings.z[index], radius, pings.from[index], (1 - 0.6 * (radius / end)) * (1 - over));
    }
  }
}
