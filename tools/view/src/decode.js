// What comes over the web socket as bytes; tools/src/view/chunk/layout.rs says what stands where.

export const ANSWERED = 1;
export const HOLDS = 2;
export const EMPTIED = 4;

export const FATES = ['heard', 'range', 'noise', 'collision', 'half_duplex', 'shadow', 'asleep', 'band', 'busy', 'late', 'dead'];

const ROW_BYTES = 96;

/** One second of all AUVs, viewed in place: `buffer` from `offset` on. */
export function scene(buffer, offset) {
  const [second, auvs, rows, emissions, links] = new Uint32Array(buffer, offset, 5);
  let at = offset + 20;
  const words = (count) => {
    at += 4 * count;
    return new Uint32Array(buffer, at - 4 * count, count);
  };
  const floats = (count) => {
    at += 4 * count;
    return new Float32Array(buffer, at - 4 * count, count);
  };
  const begin = words(auvs + 1);
  const [t, x, y, z, heading, pitch] = Array.from({ length: 6 }, () => floats(rows));
  const box = Array.from({ length: 6 }, () => floats(rows));
  const clock = floats(rows);
  const flags = words(rows);
  const [pingT, pingX, pingY, pingZ] = Array.from({ length: 4 }, () => floats(emissions));
  const pings = { count: emissions, t: pingT, x: pingX, y: pingY, z: pingZ, from: words(emissions) };
  const heard = { count: links, t: floats(links), from: words(links), to: words(links) };
  return { second, begin, t, x, y, z, heading, pitch, box, clock, flags, pings, heard, bytes: buffer.byteLength };
}

/** What is known of one AUV, tick by tick, grows as more comes. */
export class Track {
  constructor(auv) {
    this.auv = auv;
    this.rows = [];
    this.fates = new Float64Array(FATES.length);
    this.end = 0;
  }

  /** Takes an answer of the server: seconds that follow those that are there. */
  take(buffer) {
    const [, , parts, rows] = new Uint32Array(buffer, 0, 4);
    const heads = new Uint32Array(buffer, 16, parts * 12);
    for (let part = 0; part < parts; part++) {
      if (heads[part * 12] < this.end) return;
      for (let fate = 0; fate < FATES.length; fate++) this.fates[fate] += heads[part * 12 + 1 + fate];
    }
    if (parts > 0) this.end = heads[(parts - 1) * 12] + 1;
    this.takeRows(buffer, 16 + 48 * parts, rows);
  }

  /** Takes a second of all AUVs, as a page without a server holds it. */
  takeSecond(second, buffer, auvs) {
    const begin = new Uint32Array(buffer, 0, auvs + 1);
    const fates = new Uint32Array(buffer, 4 * (auvs + 1), FATES.length * auvs);
    for (let fate = 0; fate < FATES.length; fate++) this.fates[fate] += fates[this.auv * FATES.length + fate];
    this.end = second + 1;
    const rows = 4 * (auvs + 1) + 4 * FATES.length * auvs;
    this.takeRows(buffer, rows + ROW_BYTES * begin[this.auv], begin[this.auv + 1] - begin[this.auv]);
  }

  takeRows(buffer, offset, rows) {
    const view = new DataView(buffer);
    for (let row = 0; row < rows; row++) {
      const at = offset + row * ROW_BYTES;
      const float = (index) => view.getFloat32(at + 8 + 4 * index, true);
      const floats = (first, count) => Array.from({ length: count }, (_, index) => float(first + index));
      this.rows.push({
        t: view.getFloat64(at, true),
        position: floats(0, 3),
        box: floats(3, 6),
        offset: float(9),
        clock: floats(10, 2),
        slice: floats(12, 6),
        sliceClock: floats(18, 2),
        flags: view.getUint32(at + 88, true),
        neighbours: view.getUint16(at + 92, true),
        contractions: view.getUint16(at + 94, true),
      });
    }
  }

  /** Index of the last row at or before `t`; -1 before the first. */
  at(t) {
    let [low, high] = [0, this.rows.length];
    while (low < high) {
      const middle = (low + high) >> 1;
      if (this.rows[middle].t <= t) low = middle + 1;
      else high = middle;
    }
    return low - 1;
  }
}
