// The plots over the drive: of one run, or of all runs of a group over each other.
import { quantile } from '../colour/colourings.js';
import { troubledRanges } from '../runs.js';

const seriesColour = (k) => `--series-${k % 8}`;

/** Of a plot with several series the one that stands for all of it when runs are compared. */
export const leadingSeries = (plot) =>
  plot.series.find(({ name }) => name === 'total' || name === 'estimate') ?? plot.series.find(({ broad }) => !broad) ?? plot.series[0];

/** What a line says of whose it is, where several runs are compared. */
export const runLook = ({ index, run, colour, dash }) => ({ name: run.name, run: index, colour, dash });

/** Values that lines are compared with, by name. */
const levelsOf = (plot) => (plot.levels ?? []).map(([value, name]) => ({ value, name }));

const looks = (plot) => ({ log: plot.log, fromZero: plot.from_zero, whole: plot.whole_numbers });

const LEVELS_APART = 8;

/** Whether runs differ so much that the better ones would lie flat on the axis: then only a logarithm shows them all. */
export function needsLogarithm(lists) {
  const levels = lists.map((list) => quantile(list, 0.5, null)).filter((level) => level !== null);
  return levels.length > 1 && Math.min(...levels) > 0 && Math.max(...levels) > LEVELS_APART * Math.min(...levels);
}

/** @returns {import('./chart.js').Plot[]} over seconds */
export function plotsOfRun(run) {
  const xs = run.frames.seconds;
  const half = xs.length > 1 ? 0.5 * (xs.at(-1) - xs[0]) / (xs.length - 1) : 0.5;
  const marks = troubledRanges(run).map(({ from, to, status }) => ({ from: xs[from] - half, to: xs[to] + half, status }));
  return run.plots.map((plot) => {
    let colour = 0;
    return {
      id: plot.id, title: plot.title, unit: plot.unit, xName: 'time (s)', y: looks(plot), levels: levelsOf(plot),
      x: { low: xs[0] ?? 0, high: xs.at(-1) ?? 1 }, marks,
      series: plot.series.map(({ name, values, broad }) =>
        ({ name, xs, ys: values, broad, colour: broad ? '--muted' : seriesColour(colour++) })),
    };
  });
}

/** The same plots of several runs, the runs told apart by colour. @param {{run: object, colour: string}[]} shown */
export function plotsOfRuns(shown) {
  const ids = [...new Set(shown.flatMap(({ run }) => run.plots.map(({ id }) => id)))];
  const all = shown.flatMap(({ run }) => run.frames.index);
  let [low, high] = [Infinity, -Infinity];
  for (const index of all) [low, high] = [Math.min(low, index), Math.max(high, index)];
  return ids.map((id) => {
    const having = shown.filter(({ run }) => run.plots.some((plot) => plot.id === id));
    const first = having[0].run.plots.find((plot) => plot.id === id);
    const lead = leadingSeries(first).name;
    const values = having.map(({ run }) => leadingSeries(run.plots.find((plot) => plot.id === id)).values);
    const log = first.log || (!first.whole_numbers && needsLogarithm(values));
    return {
      id, title: first.series.length > 1 ? `${first.title}, ${lead}` : first.title, unit: first.unit, xName: 'scan',
      y: { ...looks(first), log, fromZero: first.from_zero && !log },
      x: { low, high: Math.max(high, low + 1), whole: true }, levels: levelsOf(first),
      series: having.map((entry, k) => ({ ...runLook(entry), xs: entry.run.frames.index, ys: values[k] })),
    };
  });
}
