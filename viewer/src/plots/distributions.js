// How errors and times are distributed: the share of frames that stay below a value.
import { leadingSeries, runLook } from './time_plots.js';

const DISTRIBUTED = ['translation_error', 'rotation_error', 'milliseconds', 'iterations'];
const MOST_STEPS = 400;

/**
 * @param {(number|null)[]} values
 * @returns {{xs: number[], ys: number[]}} a staircase: values, and the share (%) of all below and up to them
 */
export function cumulative(values) {
  const sorted = values.filter((value) => value !== null && Number.isFinite(value)).sort((a, b) => a - b);
  const steps = Math.min(sorted.length, MOST_STEPS);
  const xs = [];
  const ys = [];
  let share = 0;
  for (let k = 1; k <= steps; ++k) {
    const count = Math.round((k * sorted.length) / steps);
    xs.push(sorted[count - 1], sorted[count - 1]);
    const next = (100 * count) / sorted.length;
    ys.push(share, next);
    share = next;
  }
  return { xs, ys };
}

/** @param {{run: object, colour: string}[]} shown @returns {import('./chart.js').Plot[]} */
export function distributionsOf(shown) {
  return DISTRIBUTED.flatMap((id) => {
    const having = shown.filter(({ run }) => run.plots.some((plot) => plot.id === id));
    if (having.length === 0) return [];
    const plot = having[0].run.plots.find((entry) => entry.id === id);
    const series = having.map((shownRun) => ({
      ...runLook(shownRun), ...cumulative(leadingSeries(shownRun.run.plots.find((entry) => entry.id === id)).values),
    })).filter(({ xs }) => xs.length > 0);
    if (series.length === 0) return [];
    const positive = series.flatMap(({ xs }) => xs).filter((value) => value > 0).sort((a, b) => a - b);
    // Errors reach over decades when runs of different quality are compared.
    const [low, high] = [positive[Math.floor(0.02 * positive.length)] ?? 0.1, positive.at(-1) ?? 1];
    const log = id !== 'iterations' && high / low > 8;
    return [{
      id: `${id}-distribution`, title: `${plot.title}, CDF`, unit: '% of frames', xName: plot.unit ? `${plot.title} (${plot.unit})` : plot.title,
      y: {}, yRange: { low: 0, high: 101 }, series, x: log ? { low, high, log } : { low: 0, high },
    }];
  });
}
