// The seconds of a run that are here, fetched around the moment that is shown and forgotten far from it.

import { scene } from './decode.js';

const LIMIT_BYTES = 320 << 20;
const UNDER_WAY_MAX = 4;
const AHEAD = 24;

export class Film {
  constructor(source) {
    this.source = source;
    this.seconds = new Map();
    this.asked = new Set();
    this.bytes = 0;
    this.first = 0;
    this.end = 0;
    this.done = false;
    this.figures = [];
    /** Seconds before the moment that are needed, too. */
    this.behind = AHEAD / 2;
  }

  /** How far the server has come. */
  reach({ first, end, done, figures }) {
    Object.assign(this, { first, end, done });
    this.figures = this.figures.concat(figures).filter(({ second }) => second >= first);
  }

  take(second, buffer, offset) {
    this.asked.delete(second);
    const taken = scene(buffer, offset);
    this.bytes += taken.bytes - (this.seconds.get(second)?.bytes ?? 0);
    this.seconds.set(second, taken);
  }

  get(second) {
    return this.seconds.get(second);
  }

  /** Asks for what is next needed around `t`, and forgets what is farthest when there is too much. */
  tend(t) {
    const here = Math.floor(t);
    const wanted = [here, here + 1, here - 1];
    for (let step = 2; step <= AHEAD; step++) wanted.push(here + step);
    for (let step = 2; step <= this.behind; step++) wanted.push(here - step);
    for (const second of wanted) {
      if (this.asked.size >= UNDER_WAY_MAX) break;
      if (second < this.first || second >= this.end || this.seconds.has(second) || this.asked.has(second)) continue;
      this.asked.add(second);
      this.source.askScene(second);
    }
    while (this.bytes > LIMIT_BYTES && this.seconds.size > 4) {
      const distance = (second) => (second >= here ? second - here : 2 * (here - second));
      const farthest = [...this.seconds.keys()].reduce((one, other) => (distance(one) > distance(other) ? one : other));
      this.bytes -= this.seconds.get(farthest).bytes;
      this.seconds.delete(farthest);
    }
  }
}
