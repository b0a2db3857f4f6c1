// One plot: a canvas that is drawn when its data, size or colours change, and a cursor over it that moves by itself.
import { element, put } from '../dom.js';
import { shortNumber } from '../format.js';
import { drawnByProcessor } from '../processor.js';
import { closest } from '../runs.js';
import { cssColour } from '../theme.js';
import { tracePolyline } from './polyline.js';
import { createScale, labelBeside, tickText, valueRange } from './scale.js';

const EDGE = { left: 44, right: 8, top: 6, bottom: 18 };
const FONT = '11px system-ui, "DejaVu Sans", sans-serif';
const LETTERS = 13; // px of their height

/**
 * @typedef {object} Series
 * @property {string} name
 * @property {string} colour a CSS colour or the name of a CSS variable
 * @property {ArrayLike<number>} xs ascending
 * @property {ArrayLike<number|null>} ys
 * @property {ArrayLike<number|null>} [sigma] standard deviations, drawn as a band about the line
 * @property {boolean} [broad] a broad pale line, for what others are compared with
 * @property {boolean} [dash]
 * @property {number} [run] whose line it is, where several are compared
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
 * @property {{value: number, name: string}[]} [levels] values of y that lines are compared with
 */

const resolved = (colour) => (colour.startsWith('--') ? cssColour(colour) : colour);

const DRAG = 5; // px; less is a click

/**
 * A click picks, a drag zooms, a drag with Shift picks all along, a double click shows all again.
 * @param {Plot} plot
 * @param {object} [use]
 * @param {(x: number) => void} [use.pick] clicked at this x
 * @param {(span: [number, number]|null) => void} [use.zoom] wants to see this stretch of x, or all
 * @param {{is: boolean, toggle: () => void}} [use.fold] whether it shows nothing but its title, and how that is changed
 */
export function createChart(plot, { pick, zoom, fold } = {}) {
  const canvas = element('canvas', { role: 'img', 'aria-label': describe(plot), tabindex: pick ? 0 : null });
  const cursor = element('div', { class: 'cursor', hidden: true });
  const hoverLine = element('div', { class: 'cursor hover', hidden: true });
  const selection = element('div', { class: 'selection', hidden: true });
  const area = element('div', { class: pick ? 'chart-area picks' : 'chart-area', hidden: fold?.is }, canvas, selection, hoverLine, cursor);
  const at = element('span', { class: 'chart-at' });
  const values = plot.series.map((series) => {
    const swatch = element('i', { class: series.broad ? 'swatch broad' : series.dash ? 'swatch dash' : 'swatch' });
    const value = element('b');
    return { series, swatch, value, element: element('span', { class: 'reading' }, swatch, element('span', { text: series.name }), value) };
  });
  const figure = element('figure', { class: 'chart', data: { plot: plot.id ?? '' } },
    element('figcaption', {},
      fold ? element('button', {
        type: 'button', class: 'fold', 'aria-expanded': String(!fold.is), 'aria-label': `${fold.is ? 'Show' : 'Hide'} the plot: ${plot.title}`,
        text: fold.is ? '▸' : '▾', on: { click: fold.toggle },
      }) : null,
      element('span', { class: 'chart-title', text: plot.title }),
      element('span', { class: 'chart-unit', text: plot.unit }),
      ...values.map((entry) => entry.element), at), area);

  let x = null;
  let y = null;
  let span = null; // [low, high] of x that is shown, null for all
  let highlighted = null; // the run whose line is drawn strong while others are pale
  let now = null; // x of the current frame
  let hovered = null;

  function describeAt(value) {
    put(at, 'textContent', hovered === null ? '' : `${plot.xName.split(' (')[0]} ${shortNumber(value, 4)}`);
    for (const { series, value: place } of values) {
      const k = value === null || series.xs.length === 0 ? -1 : closest(series.xs, value);
      put(place, 'textContent', k < 0 ? '' : shortNumber(series.ys[k]));
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

  function drawLevels(pen, width) {
    for (const { value, name } of plot.levels ?? []) {
      const place = Math.round(y.place(value)) + 0.5;
      pen.strokeStyle = pen.fillStyle = resolved('--ink');
      pen.lineWidth = 1;
      pen.setLineDash([2, 3]);
      pen.beginPath();
      pen.moveTo(EDGE.left, place);
      pen.lineTo(width - EDGE.right, place);
      pen.stroke();
      pen.setLineDash([]);
      pen.textAlign = 'right';
      const label = labelBeside(place, LETTERS);
      const right = width - EDGE.right - 3;
      const letters = pen.measureText(name).width;
      pen.fillStyle = resolved('--background');
      pen.globalAlpha = 0.85; // letters stay readable over lines, which still show
      pen.fillRect(right - letters - 2, label.baseline === 'top' ? label.y : label.y - LETTERS, letters + 4, LETTERS);
      pen.globalAlpha = 1;
      pen.fillStyle = resolved('--ink');
      pen.textBaseline = label.baseline;
      pen.fillText(name, right, label.y);
    }
  }

  /** Bands of one standard deviation: a piece for each stretch of values without a gap. */
  function drawBand(pen, { colour, xs, ys, sigma }) {
    pen.fillStyle = resolved(colour);
    pen.globalAlpha = 0.2;
    const isKnown = (k) => k < ys.length && ys[k] !== null && sigma[k] !== null;
    for (let from = 0; from < ys.length; ++from) {
      if (!isKnown(from)) continue;
      let to = from;
      while (isKnown(to + 1)) ++to;
      pen.beginPath();
      for (let k = from; k <= to; ++k) pen.lineTo(x.place(xs[k]), y.place(ys[k] + sigma[k]));
      for (let k = to; k >= from; --k) pen.lineTo(x.place(xs[k]), y.place(ys[k] - sigma[k]));
      pen.fill();
      from = to;
    }
    pen.globalAlpha = 1;
  }

  function drawSeries(pen, series) {
    const { colour, xs, ys, broad, dash } = series;
    if (series.sigma) drawBand(pen, series);
    pen.strokeStyle = pen.fillStyle = resolved(colour);
    const isBehind = highlighted !== null && series.run !== highlighted;
    pen.globalAlpha = isBehind ? 0.15 : broad ? 0.4 : 1;
    pen.lineWidth = broad ? 4.5 : highlighted !== null && !isBehind ? 2.4 : 1.4;
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

  /** The values within the stretch that is shown; of others the scale need not know. */
  function valuesShown({ xs, ys, sigma }) {
    const seen = Array.from(ys, (value, k) => (!span || (xs[k] >= span[0] && xs[k] <= span[1]) ? value : null));
    return sigma ? [seen, seen.map((value, k) => (value === null || sigma[k] === null ? null : value + sigma[k]))] : [seen];
  }

  function draw() {
    const width = area.clientWidth;
    const height = area.clientHeight;
    if (width < 60 || height < 40) return;
    const ratio = Math.min(2, window.devicePixelRatio || 1);
    canvas.width = Math.round(width * ratio);
    canvas.height = Math.round(height * ratio);
    const pen = canvas.getContext('2d', { willReadFrequently: drawnByProcessor() }); // such a canvas stays in memory, where the page shows it at no cost
    pen.scale(ratio, ratio);
    x = createScale({ ...plot.x, ...(span ? { low: span[0], high: span[1] } : {}), from: EDGE.left, to: width - EDGE.right });
    y = createScale({
      ...valueRange([...plot.series.flatMap(valuesShown), (plot.levels ?? []).map(({ value }) => value)], plot.y), ...plot.yRange, log: plot.y.log, whole: plot.y.whole,
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
    drawLevels(pen, width);
    for (const { series, swatch } of values) swatch.style.setProperty('--swatch', resolved(series.colour));
    placeCursors();
  }

  function placeCursors() {
    if (!x) return;
    put(cursor, 'hidden', now === null || now < x.low || now > x.high);
    if (!cursor.hidden) cursor.style.transform = `translateX(${x.place(now)}px)`;
    put(hoverLine, 'hidden', hovered === null);
    if (hovered !== null) hoverLine.style.transform = `translateX(${x.place(hovered)}px)`;
  }

  const valueAt = (event) => {
    const value = x.value(event.clientX - canvas.getBoundingClientRect().left);
    return Math.min(x.high, Math.max(x.low, value));
  };
  let pressed = null; // {at: px, x: value, picks: bool}, from a press to its release
  const isDragged = (event) => Math.abs(event.clientX - pressed.at) >= DRAG;
  const endDrag = () => {
    pressed = null;
    selection.hidden = true;
  };
  area.addEventListener('pointermove', (event) => {
    if (!x) return;
    hovered = valueAt(event);
    if (pressed?.picks) {
      pick(hovered);
    } else if (pressed) {
      const [left, right] = [x.place(pressed.x), x.place(hovered)].sort((a, b) => a - b);
      selection.hidden = !isDragged(event);
      Object.assign(selection.style, { left: `${left}px`, width: `${right - left}px` });
    }
    describeAt(hovered);
    placeCursors();
  });
  area.addEventListener('pointerdown', (event) => {
    if (!x || !pick || event.button !== 0) return;
    if (event.pointerType === 'mouse') area.setPointerCapture(event.pointerId);
    pressed = { at: event.clientX, x: valueAt(event), picks: event.shiftKey || !zoom };
    if (pressed.picks) pick(pressed.x);
  });
  area.addEventListener('pointerup', (event) => {
    if (!pressed) return;
    const { x: from, picks } = pressed;
    const dragged = isDragged(event);
    endDrag();
    if (picks) return;
    const to = valueAt(event);
    if (dragged) zoom([Math.min(from, to), Math.max(from, to)]);
    else pick(to);
  });
  area.addEventListener('pointercancel', endDrag);
  if (zoom) area.addEventListener('dblclick', () => zoom(null));
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
    /** @param {[number, number]|null} shown stretch of x, null for all */
    setSpan(shown) {
      span = shown;
      draw();
    },
    /** @param {number|null} run see `Series.run`; null: all are alike */
    highlight(run) {
      highlighted = plot.series.some((series) => series.run === run) ? run : null;
      draw();
    },
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
