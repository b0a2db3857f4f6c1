// Scales of plots: values to places, and the ticks in between.
import { shortNumber } from '../format.js';

/** Round steps (1, 2 or 5 times a power of ten) so that there are at most `most` of them. */
export function roundStep(span, most) {
  if (!(span > 0)) return 1;
  const rough = span / Math.max(1, most);
  const power = 10 ** Math.floor(Math.log10(rough));
  return [1, 2, 5, 10].map((factor) => factor * power).find((step) => step >= rough * (1 - 1e-9)) ?? 10 * power;
}

function linearTicks(low, high, most, whole) {
  const step = Math.max(roundStep(high - low, most), whole ? 1 : 0);
  const ticks = [];
  for (let k = Math.ceil(low / step - 1e-9); k * step <= high + 1e-9 * step; ++k) ticks.push(Number((k * step).toPrecision(12)));
  return ticks;
}

function logTicks(low, high, most) {
  const first = Math.ceil(Math.log10(low) - 1e-9);
  const last = Math.floor(Math.log10(high) + 1e-9);
  const stride = Math.max(1, Math.ceil((last - first + 1) / most));
  const ticks = [];
  for (let k = first; k <= last; k += stride) ticks.push(10 ** k);
  // Within one or two decades powers of ten do not tell where one is.
  if (ticks.length >= 3) return ticks;
  const between = [first - 1, first, first + 1].flatMap((power) => [1, 2, 5].map((factor) => Number((factor * 10 ** power).toPrecision(1))));
  const inside = between.filter((tick) => tick >= low * (1 - 1e-9) && tick <= high * (1 + 1e-9));
  if (inside.length > most) return ticks;
  return inside.length >= 2 ? inside : linearTicks(low, high, most, false);
}

/** A tick's text: as many decimals as the ticks need to differ. */
export function tickText(tick, ticks) {
  const step = ticks.length > 1 ? Math.min(...ticks.slice(1).map((value, k) => Math.abs(value - ticks[k]))) : Math.abs(tick);
  const size = Math.max(...ticks.map(Math.abs));
  const digits = step > 0 && size > 0 ? Math.ceil(Math.log10(size / step) + 1e-9) + 1 : 3;
  return shortNumber(tick, Math.min(8, Math.max(3, digits)));
}

/**
 * @param {{low: number, high: number, from: number, to: number, log?: boolean, whole?: boolean}} range values `low` and
 *   `high` lie at the places `from` and `to` (pixels)
 */
export function createScale({ low, high, from, to, log = false, whole = false }) {
  const value = log ? Math.log10 : (v) => v;
  const [a, b] = [value(low), value(high)];
  const span = b - a || 1;
  return {
    low, high,
    /** Values that a logarithmic scale cannot show lie at its end. */
    place: (v) => from + ((value(log ? Math.max(v, low) : v) - a) / span) * (to - from),
    value: (place) => {
      const at = a + ((place - from) / (to - from)) * span;
      return log ? 10 ** at : at;
    },
    ticks: (most) => (log ? logTicks(low, high, most) : linearTicks(low, high, most, whole)),
  };
}

const LABEL_GAP = 2; // px

/** Where the name of a level stands: above its line, and below it where the picture ends before. @returns {{y: number, baseline: string}} */
export function labelBeside(line, letters) {
  return line - LABEL_GAP - letters >= 0 ? { y: line - LABEL_GAP, baseline: 'bottom' } : { y: line + LABEL_GAP + 1, baseline: 'top' };
}

/** The values a plot must show, widened to round numbers. */
export function valueRange(lists, { log = false, fromZero = false, whole = false } = {}) {
  let low = Infinity;
  let high = -Infinity;
  for (const list of lists) {
    for (const value of list) {
      if (value === null || !Number.isFinite(value) || (log && value <= 0)) continue;
      low = Math.min(low, value);
      high = Math.max(high, value);
    }
  }
  if (!Number.isFinite(low)) return log ? { low: 0.1, high: 1 } : { low: 0, high: 1 };
  if (log) {
    if (high / low < 1.001) return { low: low / 2, high: high * 2 };
    return { low: low / 1.1, high: high * 1.1 };
  }
  if (fromZero) [low, high] = [Math.min(0, low), Math.max(0, high)];
  if (high === low) [low, high] = fromZero ? [0, high || 1] : [low - 0.5, high + 0.5];
  const step = Math.max(roundStep(high - low, 4), whole ? 1 : 0);
  const margin = (value) => (fromZero && value === 0 ? 0 : 0.04 * (high - low));
  return fromZero
    ? { low: low === 0 ? 0 : low - margin(low), high: Math.max(high + margin(high), whole ? step : -Infinity) }
    : { low: low - margin(low), high: high + margin(high) };
}
