// What stands beside the water: layers, groups and AUVs on the left, charts on the right.

import { chart, timeAt } from './charts.js';
import { ANSWERED, FATES, HOLDS } from './decode.js';
import { FATE_COLOURS } from './palette.js';

const LISTED_MAX = 200;

export const find = (id) => document.getElementById(id);

/** An element with attributes, and texts or elements in it. */
export function make(name, attributes = {}, ...inside) {
  const element = document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) {
    if (key === 'swatch') element.style.setProperty('--swatch', value);
    else if (key.startsWith('on')) element[key] = value;
    else if (value !== undefined) element.setAttribute(key, value);
  }
  element.append(...inside);
  return element;
}

/** The list of AUVs that match the search. */
export class List {
  constructor(cast, select) {
    this.cast = cast;
    this.select = select;
    this.rows = new Map();
    find('search').oninput = () => this.fill();
  }

  matches() {
    const words = find('search').value.trim().toLowerCase().split(/\s+/);
    const { names } = this.cast;
    return [...names.keys()].filter((auv) => words.every((word) => names[auv].toLowerCase().includes(word) || String(auv) === word));
  }

  fill() {
    const { cast, colours } = this;
    const found = this.matches();
    this.rows.clear();
    const rows = found.slice(0, LISTED_MAX).map((auv) => {
      const width = make('output');
      const button = make(
        'button', { type: 'button', 'data-auv': auv, onclick: () => this.select(auv) },
        make('span', { class: 'swatch', swatch: colours[cast.groupOf[auv]] }), make('span', {}, cast.names[auv]), width,
      );
      this.rows.set(auv, { button, width });
      return make('li', {}, button);
    });
    const more = found.length - LISTED_MAX;
    if (more > 0) rows.push(make('li', { class: 'more' }, `and ${more.toLocaleString('en')} more: search`));
    if (found.length === 0) rows.push(make('li', { class: 'more' }, 'no AUV has this in its name'));
    find('list').replaceChildren(...rows);
    this.mark(this.selected);
  }

  mark(auv) {
    this.rows.get(this.selected)?.button.removeAttribute('aria-current');
    this.selected = auv;
    this.rows.get(auv)?.button.setAttribute('aria-current', 'true');
    this.rows.get(auv)?.button.scrollIntoView({ block: 'nearest' });
  }

  /** Tells the width of each box. */
  tell(moment) {
    for (const [auv, { width }] of this.rows) {
      const text = moment.shown[auv] ? length(moment.width(auv)) : '';
      if (width.textContent !== text) width.textContent = text;
    }
  }
}

/** Charts of the selected AUV, or of the swarm. */
export class Charts {
  constructor(cast, scrub, deselect) {
    this.cast = cast;
    this.scrub = scrub;
    this.deselect = deselect;
    this.axis = 'x';
    this.relative = false;
    this.charts = [];
  }

  /** Lays out what is shown of `auv`, or of the swarm when it is -1. */
  lay(auv) {
    this.auv = auv;
    this.charts = [];
    find('right').replaceChildren(...(auv < 0 ? this.swarm() : this.vehicle(auv)));
  }

  chart(title, note, draw, options = {}) {
    const canvas = make('canvas', { class: options.tall ? 'chart tall' : 'chart', role: 'img', 'aria-label': `${title}, ${note}` });
    const entry = { canvas, draw, options };
    const drag = (event) => event.buttons === 1 && this.scrub(timeAt(canvas, event.clientX, this.span));
    canvas.onpointerdown = (event) => {
      canvas.setPointerCapture(event.pointerId);
      drag(event);
    };
    canvas.onpointermove = drag;
    this.charts.push(entry);
    return [make('h3', {}, title, options.head ?? make('small', {}, note)), canvas];
  }

  swarm() {
    const { names, summary } = this.cast;
    this.facts = make('dl', { class: 'facts' });
    this.bars = make('div', { class: 'bars' });
    const key = (...entries) => legend(entries);
    const [median, most] = [this.accent, this.second];
    const figure = (name) => (film) => ({ t: film.figures.map(({ second }) => second + 1), value: film.figures.map((of) => of[name] ?? NaN) });
    const two = (one, other, factor) => (film) => [
      { ...figure(other)(film), colour: most, dashed: true },
      { ...figure(one)(film), colour: median, width: 1.8 },
    ].map((line) => ({ ...line, value: line.value.map((value) => value * factor) }));
    return [
      make('div', { class: 'head' }, make('h2', {}, `Swarm of ${names.length.toLocaleString('en')}`)),
      make('p', {}, summary),
      this.facts,
      ...this.chart('Width of boxes', 'm', (film) => ({ lines: two('width_m', 'width_max_m', 1)(film) }), { log: true }),
      key(['median', median], ['widest', most, 'dashed']),
      ...this.chart('Width of clock intervals', 'ms', (film) => ({ lines: two('clock_s', 'clock_max_s', 1e3)(film) }), { log: true }),
      key(['median', median], ['widest', most, 'dashed']),
      ...this.chart('Polarization', '1 when all head the same way', (film) => ({ lines: [{ ...figure('polarization')(film), colour: median }] }), { zero: true }),
      ...this.chart('Least separation', 'm', (film) => ({ lines: [{ ...figure('separation_m')(film), colour: median }] }), { zero: true }),
      make('h3', {}, 'Pings so far', make('small', {}, 'at each receiver')),
      this.bars,
    ];
  }

  vehicle(auv) {
    const { names, groupOf, groups } = this.cast;
    const colour = this.colours[groupOf[auv]];
    this.facts = make('dl', { class: 'facts' });
    this.bars = make('div', { class: 'bars' });
    const [cx, cy, cz] = [this.accent, this.second, this.third];
    const tabs = make('span', { class: 'tabs' });
    const axes = ['x', 'y', 'z', 'clock'];
    const button = (text, pressed, title, act) => make('button', { type: 'button', 'aria-pressed': pressed, title, onclick: act }, text);
    const fill = () => tabs.replaceChildren(
      ...axes.map((axis) => button(axis, axis === this.axis, `Tube of ${axis}`, () => { this.axis = axis; fill(); this.stale = true; })),
      button('\u2212 truth', this.relative, 'Relative to the truth', () => { this.relative = !this.relative; fill(); this.stale = true; }),
    );
    fill();
    this.swap = (what) => {
      if (what === 'axis') this.axis = axes[(axes.indexOf(this.axis) + 1) % axes.length];
      else this.relative = !this.relative;
      fill();
      this.stale = true;
    };
    const line = (rows, value, more) => ({ t: rows.map(({ t }) => t), value: rows.map(value), ...more });
    return [
      make(
        'div', { class: 'head' }, make('span', { class: 'swatch', swatch: colour }), make('h2', {}, names[auv]),
        make('button', { type: 'button', title: 'Back to the swarm (Esc)', onclick: this.deselect }, 'Swarm'),
      ),
      make('p', {}, `AUV ${auv} of group ${groups[groupOf[auv]].name}`),
      this.facts,
      ...this.chart('Tube', 'm or ms', (_, rows) => this.tube(rows, colour), { tall: true, head: tabs }),
      legend([['what it knows', colour, 'band'], ['centre', colour], ['truth', this.ink]]),
      ...this.chart('Width of its box', 'm', (_, rows) => ({
        lines: [['x', 0, cx], ['y', 2, cy], ['z', 4, cz]].map(([, side, tint]) => line(rows, ({ box }) => box[side + 1] - box[side], { colour: tint })),
      }), { log: true }),
      legend([['x', cx], ['y', cy], ['z', cz]]),
      ...this.chart('Width of its clock interval', 'ms', (_, rows) => ({
        lines: [line(rows, ({ clock }) => 1e3 * (clock[1] - clock[0]), { colour: cx })],
      }), { log: true }),
      ...this.chart('Neighbours it heeds', '', (_, rows) => ({
        lines: [line(rows, ({ neighbours }) => neighbours, { colour: cx })],
      }), { zero: true }),
      make('h3', {}, 'Pings to it', make('small', {}, 'whole run')),
      this.bars,
    ];
  }

  /** The slices between ticks, the centre, and the truth. */
  tube(rows, colour) {
    const side = { x: 0, y: 2, z: 4 }[this.axis];
    const isClock = side === undefined;
    const factor = isClock ? 1e3 : 1;
    const truth = isClock ? rows.map(({ offset }) => 1e3 * offset) : rows.map(({ position }) => position[side / 2]);
    const base = this.relative ? truth : truth.map(() => 0);
    // Relative to a moving truth only what holds at the tick itself can be drawn.
    const exact = this.relative;
    const ends = rows.map(({ box, slice, clock, sliceClock }) => {
      if (isClock) return exact ? clock : sliceClock;
      return (exact ? box : slice).slice(side, side + 2);
    });
    const centres = rows.map(({ box, clock }) => (isClock ? (clock[0] + clock[1]) / 2 : (box[side] + box[side + 1]) / 2));
    const t = rows.map((row) => row.t);
    return {
      bands: [{
        t, colour, low: ends.map(([low], row) => low * factor - base[row]), high: ends.map(([, high], row) => high * factor - base[row]),
      }],
      lines: [
        { t, colour, width: 1, value: centres.map((centre, row) => centre * factor - base[row]) },
        { t, colour: this.ink, width: 1.6, value: truth.map((value, row) => value - base[row]) },
      ],
    };
  }

  /** Draws everything anew. */
  draw(film, track, now, end) {
    this.span = { from: film.first, to: Math.max(end, film.first + 1) };
    const options = { ...this.span, now, ink: this.soft, faint: this.faint };
    const rows = track?.rows ?? [];
    for (const { canvas, draw, options: own } of this.charts) chart(canvas, draw(film, rows), { ...options, ...own });
    if (this.auv < 0) this.tellSwarm(film, now);
    else this.tellVehicle(track, now);
    this.stale = false;
  }

  tellSwarm(film, now) {
    const past = film.figures.filter(({ second }) => second <= now);
    const last = past.at(-1);
    const misses = past.reduce((sum, of) => sum + of.misses, 0);
    const emitted = past.reduce((sum, of) => sum + of.emitted, 0);
    fillFacts(this.facts, last ? [
      ['median box', length(last.width_m)],
      ['widest box', length(last.width_max_m)],
      ['median clock interval', duration(last.clock_s)],
      ['boxes and clocks that miss the truth', misses === 0 ? 'none' : misses.toLocaleString('en'), misses === 0 ? 'good' : 'bad'],
      ['components in range', past.findLast(({ components }) => components !== null)?.components ?? '\u2013'],
      ['pings emitted', emitted.toLocaleString('en')],
    ] : []);
    const fates = FATES.map((_, fate) => past.reduce((sum, of) => sum + of.fates[fate], 0));
    fillBars(this.bars, fates);
  }

  tellVehicle(track, now) {
    const row = track?.rows[track.at(now)];
    if (!row) {
      fillFacts(this.facts, []);
      this.bars.replaceChildren();
      return;
    }
    const missed = track.rows.filter(({ flags }) => (flags & (ANSWERED | HOLDS)) === ANSWERED).length;
    const [x, y, z] = row.position;
    const { box, clock } = row;
    fillFacts(this.facts, [
      ['east, north', `${x.toFixed(1)}, ${y.toFixed(1)} m`],
      ['depth', `${(-z).toFixed(1)} m`],
      ['box', `${[0, 2, 4].map((side) => Number((box[side + 1] - box[side]).toPrecision(3))).join(' \u00d7 ')} m`],
      ['its clock is off by', `${duration(row.offset)}`],
      ['its clock interval', duration(clock[1] - clock[0])],
      ['truth inside', missed === 0 ? `at all ${track.rows.length.toLocaleString('en')} ticks` : `not at ${missed} of ${track.rows.length} ticks`, missed === 0 ? 'good' : 'bad'],
    ]);
    fillBars(this.bars, track.fates);
  }
}

function fillFacts(facts, rows) {
  facts.replaceChildren(...rows.flatMap(([name, value, tone]) => [make('dt', {}, name), make('dd', { class: tone }, String(value))]));
}

function fillBars(bars, counts) {
  const most = Math.max(1, ...counts);
  const rows = FATES.map((fate, index) => [fate, counts[index]]).filter(([fate, count]) => count > 0 || fate === 'heard');
  bars.replaceChildren(...rows.flatMap(([fate, count]) => {
    const bar = make('i', { swatch: FATE_COLOURS[fate] });
    bar.style.width = `${(100 * count) / most}%`;
    return [make('span', {}, fate === 'heard' ? 'heard' : `lost: ${fate.replace('_', ' ')}`), bar, make('b', {}, count.toLocaleString('en'))];
  }));
}

function legend(entries) {
  return make('div', { class: 'key' }, ...entries.map(([name, colour, kind]) => make('span', {}, make('i', { class: kind ?? '', swatch: colour }), name)));
}

/** A length for people. */
export function length(metres) {
  if (!Number.isFinite(metres)) return '\u2013';
  if (metres >= 1e4) return `${(metres / 1e3).toPrecision(3)} km`;
  if (metres >= 0.1) return `${metres.toFixed(metres >= 100 ? 0 : metres >= 10 ? 1 : 2)} m`;
  return `${(metres * 1e3).toPrecision(2)} mm`;
}

/** A short time for people. */
export function duration(seconds) {
  if (!Number.isFinite(seconds)) return '\u2013';
  const size = Math.abs(seconds);
  const [factor, unit] = size >= 1 ? [1, 's'] : size >= 1e-3 ? [1e3, 'ms'] : [1e6, '\u00b5s'];
  return `${(seconds * factor).toPrecision(3)} ${unit}`.replace('-', '\u2212');
}
