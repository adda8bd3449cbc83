// Charts over time on a canvas: bands, lines, and the moment that is shown.

const LEFT = 46;
const RIGHT = 8;
const TOP = 6;
const BOTTOM = 18;

/**
 * Draws `bands` ({ t, low, high, colour }) and `lines` ({ t, value, colour, dashed }), each an array of numbers over time, with the same
 * axes. `options`: { from, to, now, log, zero, unit, ink, faint }.
 */
export function chart(canvas, { bands = [], lines = [] }, options) {
  const { from, to, now, log, ink, faint } = options;
  const [width, height] = [canvas.clientWidth, canvas.clientHeight];
  if (width === 0) return;
  const scale = devicePixelRatio;
  if (canvas.width !== Math.round(width * scale) || canvas.height !== Math.round(height * scale)) {
    canvas.width = Math.round(width * scale);
    canvas.height = Math.round(height * scale);
  }
  const pen = canvas.getContext('2d');
  pen.setTransform(scale, 0, 0, scale, 0, 0);
  pen.clearRect(0, 0, width, height);
  const within = (t) => t >= from && t <= to;
  let [low, high] = [Infinity, -Infinity];
  const meet = (value) => {
    if (!Number.isFinite(value) || (log && value <= 0)) return;
    low = Math.min(low, value);
    high = Math.max(high, value);
  };
  for (const band of bands) {
    band.t.forEach((t, index) => {
      if (!within(t)) return;
      meet(band.low[index]);
      meet(band.high[index]);
    });
  }
  for (const line of lines) line.t.forEach((t, index) => within(t) && meet(line.value[index]));
  if (!(high >= low)) {
    pen.fillStyle = faint;
    pen.font = '11px system-ui, sans-serif';
    pen.fillText('nothing yet', LEFT, height / 2);
    return;
  }
  if (options.zero && !log) low = Math.min(low, 0);
  const axis = log ? logAxis(low, high) : linearAxis(low, high);
  const x = (t) => LEFT + ((t - from) / Math.max(1e-9, to - from)) * (width - LEFT - RIGHT);
  const y = (value) => {
    const part = (axis.of(value) - axis.of(axis.low)) / (axis.of(axis.high) - axis.of(axis.low));
    return height - BOTTOM - part * (height - TOP - BOTTOM);
  };
  pen.font = '10.5px system-ui, sans-serif';
  pen.lineWidth = 1;
  pen.textBaseline = 'middle';
  for (const tick of axis.ticks) {
    const at = Math.round(y(tick)) + 0.5;
    pen.strokeStyle = faint;
    pen.globalAlpha = 0.35;
    pen.beginPath();
    pen.moveTo(LEFT, at);
    pen.lineTo(width - RIGHT, at);
    pen.stroke();
    pen.globalAlpha = 1;
    pen.fillStyle = ink;
    pen.textAlign = 'right';
    pen.fillText(axis.label(tick), LEFT - 5, at);
  }
  pen.textBaseline = 'alphabetic';
  const times = linearAxis(from, to, 5);
  pen.textAlign = 'center';
  for (const tick of times.ticks) {
    if (tick < from || tick > to || x(tick) > width - 22) continue;
    pen.fillStyle = ink;
    pen.fillText(times.label(tick), x(tick), height - 5);
  }
  pen.textAlign = 'right';
  pen.fillText('s', width - RIGHT + 4, height - 5);
  pen.save();
  pen.beginPath();
  pen.rect(LEFT, TOP - 2, width - LEFT - RIGHT, height - TOP - BOTTOM + 4);
  pen.clip();
  for (const band of bands) {
    const columns = gather(band.t, band.low, band.high, x, within);
    pen.fillStyle = band.colour;
    pen.globalAlpha = band.alpha ?? 0.35;
    pen.beginPath();
    columns.forEach(({ at, high: top }, index) => (index ? pen.lineTo(at, y(top)) : pen.moveTo(at, y(top))));
    for (const { at, low: bottom } of columns.reverse()) pen.lineTo(at, y(bottom));
    pen.fill();
    pen.globalAlpha = 1;
  }
  for (const line of lines) {
    pen.strokeStyle = line.colour;
    pen.lineWidth = line.width ?? 1.4;
    pen.setLineDash(line.dashed ? [4, 3] : []);
    pen.beginPath();
    let drawn = false;
    for (const { at, low: bottom, high: top } of gather(line.t, line.value, line.value, x, within)) {
      if (drawn) pen.lineTo(at, y(top));
      else pen.moveTo(at, y(top));
      if (top !== bottom) pen.lineTo(at, y(bottom));
      drawn = true;
    }
    pen.stroke();
  }
  pen.setLineDash([]);
  if (within(now)) {
    pen.strokeStyle = ink;
    pen.globalAlpha = 0.8;
    pen.lineWidth = 1;
    pen.beginPath();
    pen.moveTo(x(now), TOP);
    pen.lineTo(x(now), height - BOTTOM);
    pen.stroke();
    pen.globalAlpha = 1;
  }
  pen.restore();
}

/** The moment under the pointer. */
export function timeAt(canvas, clientX, { from, to }) {
  const { left, width } = canvas.getBoundingClientRect();
  return from + ((clientX - left - LEFT) / (width - LEFT - RIGHT)) * (to - from);
}

/** Least and greatest of what falls on each pixel: nothing that stands out is left out. */
function gather(t, lows, highs, x, within) {
  const columns = [];
  let last = null;
  for (let index = 0; index < t.length; index++) {
    if (!within(t[index]) || !Number.isFinite(lows[index])) continue;
    const at = x(t[index]);
    if (last && Math.round(at) === Math.round(last.at)) {
      last.low = Math.min(last.low, lows[index]);
      last.high = Math.max(last.high, highs[index]);
    } else {
      last = { at, low: lows[index], high: highs[index] };
      columns.push(last);
    }
  }
  return columns;
}

function linearAxis(low, high, wanted = 4) {
  const span = high - low || Math.abs(high) * 0.1 || 1;
  const raw = span / wanted;
  const power = 10 ** Math.floor(Math.log10(raw));
  const step = [1, 2, 5, 10].map((factor) => factor * power).find((candidate) => candidate >= raw);
  const [bottom, top] = [Math.floor(low / step + 1e-9), Math.ceil(high / step - 1e-9)];
  const digits = Math.max(0, -Math.floor(Math.log10(step) + 1e-9));
  const ticks = Array.from({ length: top - bottom + 1 }, (_, index) => (bottom + index) * step);
  return { low: bottom * step, high: Math.max(top, bottom + 1) * step, ticks, of: (value) => value, label: (value) => number(value, digits) };
}

function logAxis(low, high) {
  const [bottom, top] = [Math.floor(Math.log10(low) + 1e-9), Math.ceil(Math.log10(high) - 1e-9)];
  const end = Math.max(top, bottom + 1);
  const step = Math.ceil((end - bottom) / 4);
  const ticks = [];
  for (let power = bottom; power <= end; power += step) ticks.push(10 ** power);
  return { low: 10 ** bottom, high: 10 ** end, ticks, of: (value) => Math.log10(Math.max(value, 10 ** bottom)), label: short };
}

const number = (value, digits) =>
  Math.abs(value) >= 1e5 || digits > 6 ? value.toExponential(1) : value.toFixed(digits).replace('-', '\u2212');

function short(value) {
  if (value >= 1e4 || value < 1e-3) return `10${[...String(Math.round(Math.log10(value)))].map((digit) => '\u2070\u00b9\u00b2\u00b3\u2074\u2075\u2076\u2077\u2078\u2079'[digit] ?? '\u207b').join('')}`;
  return String(Number(value.toPrecision(1)));
}
