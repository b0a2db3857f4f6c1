// One plot: a canvas that is drawn when its data, size or colours change, and a cursor over it that moves by itself.
import { element } from '../dom.js';
import { shortNumber } from '../format.js';
import { closest } from '../runs.js';
import { cssColour } from '../theme.js';
import { tracePolyline } from './polyline.js';
import { createScale, tickText, valueRange } from './scale.js';

const EDGE = { left: 44, right: 8, top: 6, bottom: 18 };
const FONT = '11px system-ui, "DejaVu Sans", sans-serif';

/**
 * @typedef {object} Series
 * @property {string} name
 * @property {string} colour a CSS colour or the name of a CSS variable
 * @property {ArrayLike<number>} xs ascending
 * @property {ArrayLike<number|null>} ys
 * @property {boolean} [broad] a broad pale line, for what others are compared with
 * @property {boolean} [dash]
 */

/**
 * @typedef {object} Plot
 * @property {string} title
 * @property {string} unit
 * @property {string} xName with unit
 * @property {Series[]} series
 * @property {{log?: boolean, fromZero?: boolean, whole?: boolean}} y
 * @property {{low: number, high: number, log?: boolean, whole?: boolean}} x
 * @property {{from: number, to: number, status: string}[]} [marks] stretches of x
 */

const resolved = (colour) => (colour.startsWith('--') ? cssColour(colour) : colour);

/**
 * @param {Plot} plot
 * @param {(x: number) => void} [pick] clicked or dragged to this x
 */
export function createChart(plot, pick) {
  const canvas = element('canvas', { role: 'img', 'aria-label': describe(plot), tabindex: pick ? 0 : null });
  const cursor = element('div', { class: 'cursor', hidden: true });
  const hoverLine = element('div', { class: 'cursor hover', hidden: true });
  const area = element('div', { class: pick ? 'chart-area picks' : 'chart-area' }, canvas, hoverLine, cursor);
  const at = element('span', { class: 'chart-at' });
  const values = plot.series.map((series) => {
    const swatch = element('i', { class: series.broad ? 'swatch broad' : series.dash ? 'swatch dash' : 'swatch' });
    const value = element('b');
    return { series, swatch, value, element: element('span', { class: 'reading' }, swatch, element('span', { text: series.name }), value) };
  });
  const figure = element('figure', { class: 'chart', data: { plot: plot.id ?? '' } },
    element('figcaption', {},
      element('span', { class: 'chart-title', text: plot.title }),
      element('span', { class: 'chart-unit', text: plot.unit }),
      ...values.map((entry) => entry.element), at), area);

  let x = null;
  let y = null;
  let now = null; // x of the current frame
  let hovered = null;

  function describeAt(value) {
    at.textContent = hovered === null ? '' : `${plot.xName.split(' (')[0]} ${shortNumber(value, 4)}`;
    for (const { series, value: place } of values) {
      const k = value === null || series.xs.length === 0 ? -1 : closest(series.xs, value);
      place.textContent = k < 0 ? '' : shortNumber(series.ys[k]);
    }
  }

  function drawGrid(pen, width, height) {
    pen.font = FONT;
    pen.lineWidth = 1;
    pen.strokeStyle = resolved('--grid');
    pen.fillStyle = resolved('--muted');
    pen.textAlign = 'right';
    pen.textBaseline = 'middle';
    const levels = y.ticks(Math.max(2, Math.floor((height - EDGE.top - EDGE.bottom) / 17)));
    for (const tick of levels) {
      const place = Math.round(y.place(tick)) + 0.5;
      pen.beginPath();
      pen.moveTo(EDGE.left, place);
      pen.lineTo(width - EDGE.right, place);
      pen.stroke();
      pen.fillText(tickText(tick, levels), EDGE.left - 6, place);
    }
    pen.textBaseline = 'top';
    const name = plot.xName;
    const nameWidth = pen.measureText(name).width;
    pen.textAlign = 'right';
    pen.fillText(name, width - EDGE.right, height - EDGE.bottom + 5);
    pen.textAlign = 'center';
    const columns = x.ticks(Math.max(2, Math.floor((width - EDGE.left - EDGE.right) / 64)));
    for (const tick of columns) {
      const place = x.place(tick);
      const text = tickText(tick, columns);
      if (place + pen.measureText(text).width / 2 > width - EDGE.right - nameWidth - 8) continue;
      pen.fillText(text, place, height - EDGE.bottom + 5);
    }
  }

  function drawMarks(pen, height) {
    for (const { from, to, status } of plot.marks ?? []) {
      const left = x.place(from);
      const width = Math.max(2, x.place(to) - left);
      pen.fillStyle = resolved(status === 'lost' ? '--lost' : '--degenerate');
      pen.globalAlpha = 0.22;
      pen.fillRect(left, EDGE.top, width, height - EDGE.top - EDGE.bottom);
      pen.globalAlpha = 1;
      pen.fillRect(left, EDGE.top, width, status === 'lost' ? 4 : 2);
    }
  }

  function drawSeries(pen, { colour, xs, ys, broad, dash }) {
    pen.strokeStyle = pen.fillStyle = resolved(colour);
    pen.globalAlpha = broad ? 0.4 : 1;
    pen.lineWidth = broad ? 4.5 : 1.4;
    pen.lineJoin = 'round';
    pen.setLineDash(dash ? [5, 3] : []);
    pen.beginPath();
    const places = Array.from(ys, (value) =>
      (value === null || !Number.isFinite(value) ? null : y.place(value)));
    tracePolyline(Array.from(xs, x.place), places, {
      move: (px, py) => pen.moveTo(px, py),
      line: (px, py) => pen.lineTo(px, py),
      dot: (px, py) => { pen.moveTo(px + 1.5, py); pen.arc(px, py, 1.5, 0, 2 * Math.PI); },
    });
    pen.stroke();
    pen.setLineDash([]);
    pen.globalAlpha = 1;
  }

  function draw() {
    const width = area.clientWidth;
    const height = area.clientHeight;
    if (width < 60 || height < 40) return;
    const ratio = Math.min(2, window.devicePixelRatio || 1);
    canvas.width = Math.round(width * ratio);
    canvas.height = Math.round(height * ratio);
    const pen = canvas.getContext('2d');
    pen.scale(ratio, ratio);
    x = createScale({ ...plot.x, from: EDGE.left, to: width - EDGE.right });
    y = createScale({
      ...valueRange(plot.series.map((series) => series.ys), plot.y), ...plot.yRange, log: plot.y.log, whole: plot.y.whole,
      from: height - EDGE.bottom, to: EDGE.top,
    });
    drawMarks(pen, height);
    drawGrid(pen, width, height);
    pen.save();
    pen.beginPath();
    pen.rect(EDGE.left, EDGE.top - 3, width - EDGE.left - EDGE.right, height - EDGE.top - EDGE.bottom + 6);
    pen.clip();
    for (const series of [...plot.series].sort((a, b) => Number(b.broad ?? false) - Number(a.broad ?? false))) drawSeries(pen, series);
    pen.restore();
    for (const { series, swatch } of values) swatch.style.setProperty('--swatch', resolved(series.colour));
    placeCursors();
  }

  function placeCursors() {
    if (!x) return;
    cursor.hidden = now === null;
    if (now !== null) cursor.style.transform = `translateX(${x.place(now)}px)`;
    hoverLine.hidden = hovered === null;
    if (hovered !== null) hoverLine.style.transform = `translateX(${x.place(hovered)}px)`;
  }

  const valueAt = (event) => {
    const value = x.value(event.clientX - canvas.getBoundingClientRect().left);
    return Math.min(x.high, Math.max(x.low, value));
  };
  area.addEventListener('pointermove', (event) => {
    if (!x) return;
    hovered = valueAt(event);
    if (pick && event.buttons === 1) pick(hovered);
    describeAt(hovered);
    placeCursors();
  });
  area.addEventListener('pointerdown', (event) => {
    if (!x || !pick || event.button !== 0) return;
    if (event.pointerType === 'mouse') area.setPointerCapture(event.pointerId);
    pick(valueAt(event));
  });
  area.addEventListener('pointerleave', () => {
    hovered = null;
    describeAt(now);
    placeCursors();
  });
  const watcher = new ResizeObserver(draw);
  watcher.observe(area);
  return {
    element: figure,
    draw,
    /** @param {number|null} value x of the current frame */
    setNow(value) {
      now = value;
      placeCursors();
    },
    /** Writes the values at the cursor. */
    read() { if (hovered === null) describeAt(now); },
    dispose: () => watcher.disconnect(),
  };
}

/** What a reader of the screen hears. */
function describe({ title, unit, series }) {
  const parts = series.map(({ name, ys }) => {
    const known = Array.from(ys).filter((value) => value !== null && Number.isFinite(value));
    if (known.length === 0) return `${name}: no values`;
    let [low, high] = [Infinity, -Infinity];
    for (const value of known) [low, high] = [Math.min(low, value), Math.max(high, value)];
    return `${name} from ${shortNumber(low)} to ${shortNumber(high)}`;
  });
  return `${title}${unit ? ` in ${unit}` : ''}: ${parts.join('; ')}`;
}
