// Errors over the distance driven, and over stretches of one length, as KITTI counts them.
import { runLook } from './time_plots.js';

/** A run's line of this name, or null where it has none. */
const valuesOf = (run, id) => run.plots.find((plot) => plot.id === id)?.series[0].values ?? null;

/** How far the runs are from the ground truth after so many metres. */
function driftOf(shown) {
  const series = shown.flatMap((entry) => {
    const ys = valuesOf(entry.run, 'position_error');
    return ys ? [{ ...runLook(entry), xs: entry.run.frames.distance, ys }] : [];
  });
  const longest = Math.max(...series.map(({ xs }) => xs.at(-1) ?? 0));
  return series.length && longest > 0 ? [{
    id: 'drift', title: 'Position error over the distance driven', unit: 'm', xName: 'distance (m)',
    y: { fromZero: true }, x: { low: 0, high: longest }, series,
  }] : [];
}

const STRETCHES = [
  { key: 'translation', id: 'stretch_translation', title: 'Translation error over stretches, RMSE', unit: '% of their length' },
  { key: 'rotation', id: 'stretch_rotation', title: 'Rotation error over stretches, RMSE', unit: '° in 100 m' },
];

function stretchErrorsOf(shown) {
  const having = shown.filter(({ run }) => run.stretches?.length.length > 1);
  if (having.length === 0) return [];
  const lengths = having.flatMap(({ run }) => run.stretches.length);
  return STRETCHES.map(({ key, id, title, unit }) => ({
    id, title, unit, xName: 'length (m)', y: { log: true }, x: { low: Math.min(...lengths), high: Math.max(...lengths), log: true },
    series: having.map((entry) => ({ ...runLook(entry), xs: entry.run.stretches.length, ys: entry.run.stretches[key] })),
  }));
}

/** @param {{index: number, run: object, colour: string, dash: boolean}[]} shown @returns {import('./chart.js').Plot[]} */
export const distancePlotsOf = (shown) => [...driftOf(shown), ...stretchErrorsOf(shown)];
