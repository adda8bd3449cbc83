// The page of `shoal view`: a run at one moment, and everything that leads from one moment to another.

import { Film } from './film.js';
import { Moment, memoryOf } from './moment.js';
import { groupColours } from './palette.js';
import { Charts, List, find, make } from './panel.js';
import { Track, open } from './source.js';
import { PANES, Stage } from './stage.js';

const RATES = [0.001, 0.003, 0.01, 0.03, 0.1, 0.3, 1, 3, 10, 30];
/** Seconds of wall clock for which a wavefront fades where it ends. */
const GLOW = 0.12;

const state = {
  t: 0, playing: false, rate: 1, selected: -1, follow: false, following: false, panes: false,
  layers: { bodies: true, links: false, boxes: true, waves: true },
};
let [cast, film, moment, stage, list, charts, track, visible] = [];
let [version, frames, spent, slow, last, shownNote] = [0, 0, 0, 0, 0, ''];
const hash = new URLSearchParams(location.hash.slice(1));

const source = open(hear, () => tellNote('The run is no longer shown: `shoal view` has ended.'));

function hear(message) {
  if (message.cast) begin(message.cast);
  else if (message.reached) reach(message.reached);
  else if (message.second !== undefined) {
    film.take(message.second, message.buffer, message.offset);
    // Who heard whom lately may be in it.
    if (!cast.ideal) version++;
    dirty = true;
  } else if (message.track !== undefined && track?.auv === message.track) {
    if (message.buffer) track.take(message.buffer);
    track.asked = false;
    charts.stale = true;
    dirty = true;
  }
}

let dirty = true;

function begin(told) {
  const { names, group_of: groupOf, length_m: bodies, groups } = told;
  const area = told.area_m;
  const diagonal = area ? Math.hypot(...area.map(([low, high]) => high - low)) : 1000;
  const reach = groupOf.map((group) => groups[group].range_m ?? 0.75 * diagonal);
  cast = {
    ...told, groupOf, length: bodies, reach, reachMax: reach.reduce((one, other) => Math.max(one, other), 1), soundSpeed: told.sound_speed_m_s,
  };
  film = new Film(source);
  if (!cast.ideal) film.behind = Math.max(film.behind, Math.ceil(memoryOf(cast)));
  moment = new Moment(names.length);
  visible = new Uint8Array(names.length).fill(1);
  stage = new Stage(find('water'), cast);
  list = new List(cast, (auv) => select(auv, true));
  charts = new Charts(cast, (t) => go(t), () => select(-1));
  document.title = `${told.scenario} \u2013 Shoal`;
  find('scenario').textContent = told.scenario;
  find('about').textContent = `${names.length.toLocaleString('en')} AUVs, seed ${told.seed}${told.live ? ', live' : ''}`;
  if (!cast.ideal) find('links-name').textContent = 'Links heard lately';
  find('live').hidden = !told.live;
  state.following = told.live;
  if (names.length <= 60) state.layers.links = true;
  find('note').onclick = () => tellNote('');
  restore(told);
  stage.surround(region(area));
  paint();
  requestAnimationFrame(frame);
}

/** The mission's area, unless it is unbounded or flat. */
function region(area) {
  if (!area || area.some(([low, high]) => !(high > low))) return [[-100, 100], [-100, 100], [-100, 0]];
  return area;
}

/** What the address says behind #: moment, AUV, layers. */
function restore(told) {
  const { layers } = state;
  if (hash.has('layers')) for (const name of Object.keys(layers)) layers[name] = hash.get('layers').split(',').includes(name);
  state.rate = RATES.find((rate) => rate === Number(hash.get('rate'))) ?? 1;
  state.panes = hash.has('panes');
  state.playing = !hash.has('pause') && !hash.has('t') && !matchMedia('(prefers-reduced-motion: reduce)').matches;
  if (told.live) state.playing = true;
  if (hash.has('t')) {
    state.t = Number(hash.get('t')) || 0;
    state.following = false;
  }
  const theme = hash.get('theme') ?? (matchMedia('(prefers-color-scheme: light)').matches ? 'light' : 'dark');
  document.documentElement.dataset.theme = theme;
  find('rate').replaceChildren(...RATES.map((rate) => make('option', { value: rate }, rate < 1 ? `1/${Math.round(1 / rate)}` : `${rate}\u00d7`)));
}

function reach(message) {
  film.reach(message);
  if (message.note) tellNote(message.note);
  find('end').textContent = film.end.toLocaleString('en');
  const scrub = find('scrub');
  [scrub.min, scrub.max] = [film.first, film.end];
  if (hash.has('auv') && film.end > 0 && state.selected < 0) {
    const wanted = hash.get('auv');
    hash.delete('auv');
    select(cast.names.includes(wanted) ? cast.names.indexOf(wanted) : Number(wanted), true);
  }
  if (cast.live && message.done) {
    state.following = false;
    find('live').hidden = true;
    find('about').textContent = find('about').textContent.replace(', live', '');
  }
  if (track) askTrack();
  charts.stale = true;
  dirty = true;
}

function askTrack() {
  if (track.asked || track.end >= film.end) return;
  track.asked = true;
  source.askTrack(track);
}

function tellNote(text) {
  find('note').hidden = !text;
  find('note').textContent = text;
  shownNote = text;
}

/** Colours of everything, for the theme. */
function paint() {
  const theme = document.documentElement.dataset.theme;
  const style = getComputedStyle(document.documentElement);
  const colour = (name) => style.getPropertyValue(`--${name}`).trim();
  const colours = groupColours(cast.groups.map(({ name }) => name), theme);
  stage.paint({ dark: theme === 'dark', colours, line: colour('water') });
  const [accent, second, third] = theme === 'dark' ? ['#56b4e9', '#e69f00', '#cc79a7'] : ['#0072b2', '#d55e00', '#009e73'];
  Object.assign(charts, { colours, accent, second, third, ink: colour('ink'), soft: colour('soft'), faint: colour('faint') });
  list.colours = colours;
  list.fill();
  fillGroups(colours);
  charts.lay(state.selected);
  charts.stale = true;
  find('theme').textContent = theme === 'dark' ? 'Light' : 'Dark';
  version++;
  dirty = true;
}

function fillGroups(colours) {
  const rows = cast.groups.map(({ name }, group) => {
    const members = cast.groupOf.filter((of) => of === group).length;
    const button = make(
      'button', { type: 'button', 'aria-pressed': 'true', title: `Show or hide ${name}` },
      make('span', { class: 'swatch', swatch: colours[group] }), make('span', {}, name), make('output', {}, members.toLocaleString('en')),
    );
    button.setAttribute('aria-pressed', String(cast.groupOf.every((of, auv) => of !== group || visible[auv])));
    button.onclick = () => {
      const on = button.getAttribute('aria-pressed') !== 'true';
      button.setAttribute('aria-pressed', String(on));
      cast.groupOf.forEach((of, auv) => { if (of === group) visible[auv] = on ? 1 : 0; });
      version++;
      dirty = true;
    };
    return button;
  });
  find('groups').replaceChildren(...rows);
}

/** Goes to a moment. */
function go(t) {
  if (!film) return;
  state.t = Math.min(Math.max(t, film.first), Math.max(film.first, film.end - 0.001));
  if (cast.live) state.following = state.following && t >= film.end - 1.5;
  dirty = true;
}

/** Selects an AUV, or none with -1; `near` moves the camera to it. */
function select(auv, near) {
  if (!(auv >= -1 && auv < cast.names.length) || !Number.isInteger(auv)) return;
  state.selected = auv;
  track = auv < 0 ? undefined : new Track(auv);
  if (track) askTrack();
  state.near = near && auv >= 0;
  list.mark(auv);
  charts.lay(auv);
  charts.stale = true;
  version++;
  dirty = true;
}

function play(on) {
  state.playing = on;
  if (on && !cast.live && state.t >= film.end - 0.01) state.t = film.first;
  dirty = true;
}

function frame(now) {
  requestAnimationFrame(frame);
  const began = performance.now();
  const passed = Math.min(0.25, (now - last) / 1000);
  last = now;
  advance(passed);
  film.tend(state.t);
  const moved = stage.controls.update();
  if (!dirty && !moved && !resized()) return;
  const ready = moment.go(film, state.t);
  find('loading').hidden = ready || film.end === 0;
  if (film.end === 0 || (!ready && !moment.shown.some((one) => one))) return;
  if (state.near && moment.shown[state.selected]) {
    state.near = false;
    approach();
  }
  follow();
  const { layers, selected } = state;
  stage.fill(moment, film, {
    visible, selected, version, layers: state.panes ? { bodies: true, links: true, boxes: true, waves: true } : layers,
    glow: GLOW * state.rate, track: track && selected >= 0 && visible[selected] ? track : undefined,
  });
  const main = find('water').parentElement;
  stage.draw(main.clientWidth, main.clientHeight, state.panes);
  label(main.clientWidth, main.clientHeight);
  dirty = false;
  frames++;
  spent += performance.now() - began;
  tell(now);
}

function advance(passed) {
  if (!state.playing || !film || film.end === 0) return;
  if (state.following) {
    // What was told last is shown smoothly, a little later.
    const target = film.end - 0.3;
    const lag = target - state.t;
    state.t = lag > 5 || lag < -1 ? target : state.t + Math.max(0, Math.min(lag, passed * (1 + lag)));
  } else {
    const next = state.t + passed * state.rate;
    // Time waits for what is not here yet.
    if (film.get(Math.floor(state.t)) && !film.get(Math.floor(next)) && next < film.end) return;
    state.t = next;
    if (state.t >= film.end - 0.001) {
      state.t = Math.max(film.first, film.end - 0.001);
      if (film.done) state.playing = false;
    }
  }
  if (state.t < film.first) state.t = film.first;
  dirty = true;
}

function approach() {
  const [x, y, z] = moment.position.slice(3 * state.selected, 3 * state.selected + 3);
  const width = moment.width(state.selected);
  const distance = Math.min(stage.size * 0.9, Math.max(stage.size * 0.22, 6 * (Number.isFinite(width) ? width : 0), 12));
  stage.approach(x, y, z, distance);
}

function follow() {
  const auv = state.selected;
  if (!state.follow || auv < 0 || !moment.shown[auv]) return;
  stage.follow(moment.position[3 * auv], moment.position[3 * auv + 1], moment.position[3 * auv + 2]);
}

let size = '';
function resized() {
  const main = find('water').parentElement;
  const now = `${main.clientWidth}x${main.clientHeight}`;
  const is = now !== size;
  size = now;
  return is;
}

/** Texts over the water: what its edges are, who is selected, what each pane shows. */
function label(width, height) {
  const labels = [];
  const put = (text, kind, x, y, shift = 'translate(-50%, -50%)') => {
    const element = make('span', { class: kind }, text);
    element.style.transform = `translate(${x.toFixed(1)}px, ${y.toFixed(1)}px) ${shift}`;
    labels.push(element);
  };
  const panes = state.panes ? [[0, 0], [1, 0], [0, 1], [1, 1]] : [[0, 0]];
  const [across, down] = state.panes ? [width / 2, height / 2] : [width, height];
  const [[x0, x1], [y0, y1], [z0, z1]] = stage.region;
  const metres = (from, to) => `${Math.round(to - from).toLocaleString('en')} m`;
  panes.forEach(([i, j], index) => {
    const at = (x, y, z) => {
      const found = stage.project(x, y, z, across, down);
      return found && found[0] > 0 && found[0] < across && found[1] > 0 && found[1] < down ? [found[0] + i * across, found[1] + j * down] : null;
    };
    if (state.panes) put(PANES[index].title, 'pane', i * across + 12, j * down + 18, 'translate(0, -50%)');
    if (index === 0) {
      const axes = [[(x0 + x1) / 2, y0, z0, `east ${metres(x0, x1)}`], [x0, (y0 + y1) / 2, z0, `north ${metres(y0, y1)}`], [x0, y0, (z0 + z1) / 2, `depth ${Math.round(-z1)}\u2013${Math.round(-z0)} m`]];
      for (const [x, y, z, text] of axes) {
        const found = at(x, y, z);
        if (found) put(text, 'axis', found[0], found[1] + 13);
      }
    }
    const auv = state.selected;
    if (auv >= 0 && moment.shown[auv]) {
      const found = at(...moment.position.slice(3 * auv, 3 * auv + 3));
      if (found) {
        put('', 'ring', ...found);
        if (index === 0) put(cast.names[auv], 'name', found[0], found[1] - 28);
      }
    }
  });
  if (state.panes) {
    put('', 'split', width / 2, 0, '');
    Object.assign(labels.at(-1).style, { width: '1px', height: '100%' });
    put('', 'split', 0, height / 2, '');
    Object.assign(labels.at(-1).style, { width: '100%', height: '1px' });
  }
  find('labels').replaceChildren(...labels);
}

/** Everything that is text or chart: less often than pictures while time goes by. */
function tell(now) {
  find('now').textContent = state.t.toFixed(state.rate < 0.1 ? 3 : 2);
  find('scrub').value = state.t;
  find('scrub').setAttribute('aria-valuetext', `${state.t.toFixed(1)} s`);
  if (!charts.stale && now - slow < 250) {
    later();
    return;
  }
  slow = now;
  find('play').setAttribute('aria-pressed', String(state.playing));
  find('play').setAttribute('aria-label', state.playing ? 'Pause' : 'Play');
  find('rate').value = state.rate;
  find('live').setAttribute('aria-pressed', String(state.following));
  find('panes').setAttribute('aria-pressed', String(state.panes));
  for (const button of document.querySelectorAll('[data-layer]')) {
    const name = button.dataset.layer;
    button.setAttribute('aria-pressed', String(state.layers[name]));
    const on = state.layers[name] || state.panes;
    button.querySelector('output').textContent = on ? stage.counts[name].toLocaleString('en') : '';
    const stride = name === 'links' && on ? stage.counts.linksDrawn : 1;
    button.title = stride > 1 ? `One in ${stride} is drawn, and all of the selected AUV` : '';
  }
  list.tell(moment);
  charts.draw(film, track, state.t, film.end);
  strip();
}

let waiting = 0;
function later() {
  clearTimeout(waiting);
  waiting = setTimeout(() => { dirty = true; slow = 0; }, 300);
}

/** The run at a glance behind the slider: median width of boxes, and where a box missed the truth. */
function strip() {
  const canvas = find('strip');
  const [width, height] = [canvas.clientWidth, canvas.clientHeight];
  [canvas.width, canvas.height] = [width, height];
  const pen = canvas.getContext('2d');
  const span = Math.max(1, film.end - film.first);
  const x = (second) => ((second - film.first) / span) * width;
  pen.fillStyle = charts.faint;
  pen.globalAlpha = 0.18;
  pen.fillRect(0, 0, x(film.end), height);
  const widths = film.figures.map(({ width_m: median }) => median ?? 0);
  const most = widths.reduce((one, other) => Math.max(one, other), 1e-9);
  pen.globalAlpha = 0.4;
  pen.fillStyle = charts.accent;
  film.figures.forEach(({ second, misses }, index) => {
    const top = height * (1 - 0.9 * (widths[index] / most));
    pen.fillRect(x(second), top, Math.max(1, x(second + 1) - x(second) - (span < 200 ? 1 : 0)), height - top);
    if (misses === 0) return;
    pen.save();
    pen.globalAlpha = 1;
    pen.fillStyle = '#ff2859';
    pen.fillRect(x(second), 0, Math.max(2, x(second + 1) - x(second)), 4);
    pen.restore();
  });
}

// --- the pointer

let down = null;
find('water').addEventListener('pointerdown', (event) => { down = [event.clientX, event.clientY]; });
find('water').addEventListener('pointerup', (event) => {
  if (!down || Math.hypot(event.clientX - down[0], event.clientY - down[1]) > 4) return;
  const { left, top, width, height } = find('water').getBoundingClientRect();
  const [across, high] = state.panes ? [width / 2, height / 2] : [width, height];
  const [x, y] = [(event.clientX - left) % across, (event.clientY - top) % high];
  select(nearest(x, y, across, high));
});

/** Who is under the pointer, or -1. */
function nearest(x, y, width, height) {
  let [found, least] = [-1, 14];
  for (let auv = 0; auv < moment.auvs; auv++) {
    if (!moment.shown[auv] || !visible[auv]) continue;
    const at = stage.project(...moment.position.slice(3 * auv, 3 * auv + 3), width, height);
    if (!at) continue;
    const distance = Math.hypot(at[0] - x, at[1] - y);
    if (distance < least) [found, least] = [auv, distance];
  }
  return found;
}

// --- buttons and keys

const act = {
  play: () => play(!state.playing),
  layer: (name) => { state.layers[name] = !state.layers[name]; },
  panes: () => { state.panes = !state.panes; },
  home: () => stage.home(),
  follow: () => { state.follow = !state.follow; },
  theme: () => {
    const { dataset } = document.documentElement;
    dataset.theme = dataset.theme === 'dark' ? 'light' : 'dark';
    paint();
  },
  help: () => (find('help').open ? find('help').close() : find('help').showModal()),
  live: () => {
    if (!cast.live) return;
    state.following = true;
    state.playing = true;
  },
  rate: (step) => { state.rate = RATES[Math.min(Math.max(RATES.indexOf(state.rate) + step, 0), RATES.length - 1)]; state.following = false; },
  step: (seconds) => { play(false); go(state.t + seconds); },
  other: (step) => {
    const found = list.matches();
    const next = found[(found.indexOf(state.selected) + step + (state.selected < 0 && step < 0 ? 1 : 0) + found.length) % found.length];
    if (next !== undefined) select(next);
  },
};

const KEYS = [
  ['space', 'play or pause', act.play, ' '],
  ['\u2190 \u2192', 'a tenth of a second', null],
  ['Shift \u2190 \u2192', 'a second', null],
  ['Home End', 'beginning, end', null],
  ['+ \u2212', 'faster, slower', null],
  ['1', 'true positions', () => act.layer('bodies'), '1'],
  ['2', 'links', () => act.layer('links'), '2'],
  ['3', 'localization boxes', () => act.layer('boxes'), '3'],
  ['4', 'ping wavefronts', () => act.layer('waves'), '4'],
  ['p', 'four panes', act.panes, 'p'],
  ['n N', 'next, previous AUV', null],
  ['f', 'stay with the AUV', act.follow, 'f'],
  ['c', 'go to the AUV', () => { if (state.selected >= 0) state.near = true; }, 'c'],
  ['a', 'tube of x, y, z, clock', () => charts.auv >= 0 && charts.swap('axis'), 'a'],
  ['t', 'tube less the truth', () => charts.auv >= 0 && charts.swap('relative'), 't'],
  ['/', 'search', () => find('search').focus(), '/'],
  ['Esc', 'select nobody', () => select(-1), 'Escape'],
  ['r', 'show all', act.home, 'r'],
  ['l', 'follow a live run', act.live, 'l'],
  ['d', 'dark or light', act.theme, 'd'],
  ['?', 'this', act.help, '?'],
];
const MORE = {
  ArrowLeft: (shift) => act.step(shift ? -1 : -0.1),
  ArrowRight: (shift) => act.step(shift ? 1 : 0.1),
  Home: () => go(film.first),
  End: () => (cast.live ? act.live() : go(film.end)),
  '+': () => act.rate(1),
  '=': () => act.rate(1),
  '-': () => act.rate(-1),
  n: () => act.other(1),
  N: () => act.other(-1),
};

addEventListener('keydown', (event) => {
  if (!cast || event.ctrlKey || event.metaKey || event.altKey) return;
  const { target, key } = event;
  if (target.id === 'search') {
    if (key === 'Enter' && list.matches().length > 0) select(list.matches()[0], true);
    if (key === 'Escape' || key === 'Enter') target.blur();
    return;
  }
  if (find('help').open && key !== '?') return;
  if (target.matches('button, select') && [' ', 'Enter', 'ArrowUp', 'ArrowDown'].includes(key)) return;
  const does = MORE[key] ?? KEYS.find((entry) => entry[3] === key)?.[2];
  if (!does) return;
  event.preventDefault();
  does(event.shiftKey);
  changed();
});

/** Everything is told anew. */
function changed() {
  slow = 0;
  charts.stale = true;
  dirty = true;
}

function on(id, does) {
  find(id).addEventListener('click', () => {
    if (!cast) return;
    does();
    changed();
  });
}
on('play', act.play);
on('panes', act.panes);
on('home', act.home);
on('theme', act.theme);
on('ask', act.help);
on('live', act.live);
for (const button of document.querySelectorAll('[data-layer]')) {
  button.addEventListener('click', () => {
    act.layer(button.dataset.layer);
    changed();
  });
}
find('scrub').addEventListener('input', ({ target }) => {
  state.following = false;
  go(Number(target.value));
  charts.stale = true;
});
find('rate').addEventListener('change', ({ target }) => {
  state.rate = Number(target.value);
  state.following = false;
  changed();
});
find('keys').append(...KEYS.flatMap(([keys, what]) => [make('dt', {}, keys), make('dd', {}, what)]));
addEventListener('resize', () => { dirty = true; });
matchMedia('(prefers-color-scheme: light)').addEventListener('change', ({ matches }) => {
  if (!cast) return;
  document.documentElement.dataset.theme = matches ? 'light' : 'dark';
  paint();
});

/** For tests and the curious: what is shown. */
window.shoal = {
  get facts() {
    return {
      t: state.t, end: film?.end, done: film?.done, auvs: cast?.names.length, selected: state.selected, playing: state.playing, rate: state.rate,
      counts: stage?.counts, calls: stage?.renderer.info.render.calls, frames, spent, note: shownNote, rows: track?.rows.length, panes: state.panes,
      layers: state.layers, theme: document.documentElement.dataset.theme, following: state.following,
      ready: Boolean(film?.get(Math.floor(state.t))), held: film?.bytes,
    };
  },
  /** Where an AUV is on the page. */
  place(auv) {
    const { left, top, width, height } = find('water').getBoundingClientRect();
    const at = stage.project(...moment.position.slice(3 * auv, 3 * auv + 3), width, height);
    return at && [at[0] + left, at[1] + top];
  },
};
