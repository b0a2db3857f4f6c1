// Which run is best: the number of each, and how far it spreads, over the drives of the page or over the scans of one.
import { quantile } from '../colour/colourings.js';
import { groupsOf } from '../session.js';
import { leadingSeries } from './time_plots.js';

const MEASURES = [
  { key: 'rte_rmse_m', title: 'RTE, RMSE', unit: 'mm', factor: 1000, plot: 'translation_error' },
  { key: 'rre_rmse_deg', title: 'RRE, RMSE', unit: '°', factor: 1, plot: 'rotation_error' },
  { key: 'ate_rmse_m', title: 'ATE, RMSE', unit: 'mm', factor: 1000, plot: null },
  { key: 'ms_mean', title: 'Time per scan, mean', unit: 'ms', factor: 1, plot: 'milliseconds' },
];
const LEVELS_APART = 12; // of the numbers of runs: beyond, the better ones can only be told apart by a logarithm

const numberOf = (run, { key, factor }) => {
  const number = run.summary.find((entry) => entry.key === key)?.number ?? null;
  return number === null ? null : factor * number;
};

function medianOf(values) {
  const sorted = [...values].sort((a, b) => a - b);
  const middle = sorted.length >> 1;
  return sorted.length === 0 ? null : sorted.length % 2 ? sorted[middle] : (sorted[middle - 1] + sorted[middle]) / 2;
}

/** Where 90 of 100 scans of a run lie; null where that is not known. */
function spreadOverScans(run, measure) {
  const plot = run.plots.find(({ id }) => id === measure.plot);
  const values = plot ? leadingSeries(plot).values.filter((value) => value !== null && Number.isFinite(value)) : [];
  return values.length ? [quantile(values, 0.05, null), quantile(values, 0.95, null)] : null;
}

/** One run's row, with its spread over drives: of all runs that have its colour, which are those of one method over the drives of the page. */
function rowOf(report, { index, run, colour, dash }, measure) {
  const drives = groupsOf(report).flatMap(({ name, runs }) => runs
    .filter((other) => other === index || (run.colour !== undefined && report.runs[other].colour === run.colour))
    .map((other) => ({ drive: name, value: numberOf(report.runs[other], measure) })))
    .filter(({ value }) => value !== null);
  const values = drives.map(({ value }) => value);
  return {
    index, name: run.name, colour, dash, drives,
    value: medianOf(values),
    spread: values.length > 1 ? [Math.min(...values), Math.max(...values)] : null,
  };
}

/**
 * @typedef {object} Ranking
 * @property {string} id @property {string} title @property {string} unit
 * @property {boolean} log whether the values are so far apart that they are shown by their logarithms
 * @property {number} drives over how many drives at most
 * @property {{index: number, name: string, colour: string, dash: boolean, value: number|null,
 *   spread: [number, number]|null, drives: {drive: string, value: number}[]}[]} rows the best one first
 */

/** @param {{index: number, run: object, colour: string, dash: boolean}[]} shown @returns {Ranking[]} */
export function rankingsOf(report, shown) {
  return MEASURES.flatMap((measure) => {
    const rows = shown.map((entry) => rowOf(report, entry, measure))
      .sort((a, b) => (a.value ?? Infinity) - (b.value ?? Infinity) || a.index - b.index);
    const known = rows.map(({ value }) => value).filter((value) => value !== null);
    if (known.length === 0) return [];
    const drives = Math.max(...rows.map((row) => row.drives.length));
    if (drives === 1) for (const row of rows) row.spread = row.value === null ? null : spreadOverScans(report.runs[row.index], measure);
    const log = known[0] > 0 && known.at(-1) > LEVELS_APART * known[0];
    return [{ id: measure.key, title: measure.title, unit: measure.unit, log, drives, rows }];
  });
}
