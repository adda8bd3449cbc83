// Colours that people with any colour vision tell apart: Okabe and Ito, "Color Universal Design" (2008).

const OKABE_ITO = {
  blue: '#0072b2',
  sky: '#56b4e9',
  green: '#009e73',
  vermilion: '#d55e00',
  orange: '#e69f00',
  purple: '#cc79a7',
  yellow: '#f0e442',
};

const ORDER = {
  dark: ['sky', 'orange', 'green', 'purple', 'yellow', 'vermilion', 'blue'],
  light: ['blue', 'vermilion', 'green', 'purple', 'orange', 'sky', 'yellow'],
};

// Groups that are called after a colour have it.
const NAMED = {
  dark: { blue: 'sky', green: 'green', red: 'vermilion', yellow: 'yellow', orange: 'orange', purple: 'purple' },
  light: { blue: 'blue', green: 'green', red: 'vermilion', yellow: 'yellow', orange: 'orange', purple: 'purple' },
};

/** A colour for each group, `#rrggbb`. */
export function groupColours(names, theme) {
  const named = names.map((name) => NAMED[theme][name.toLowerCase()]);
  const free = ORDER[theme].filter((colour) => !named.includes(colour));
  let next = 0;
  return named.map((colour) => OKABE_ITO[colour ?? free[next++ % Math.max(1, free.length)] ?? 'sky']);
}

/** Red, green and blue from 0 to 255. */
export function rgb(colour) {
  return [1, 3, 5].map((at) => parseInt(colour.slice(at, at + 2), 16));
}

// What became of pings, each with a colour and a place in the order of stacks.
export const FATE_COLOURS = {
  heard: OKABE_ITO.green,
  range: '#8a94a0',
  noise: OKABE_ITO.yellow,
  collision: OKABE_ITO.vermilion,
  half_duplex: OKABE_ITO.orange,
  shadow: OKABE_ITO.purple,
  asleep: OKABE_ITO.blue,
  band: OKABE_ITO.sky,
  busy: '#b89b72',
  late: '#a05195',
  dead: '#5c5f66',
};
