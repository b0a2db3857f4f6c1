// The sheet of plots over the drive, and the one of distributions.
import { button, element } from '../dom.js';
import { toggled } from '../layers.js';
import { shortNumber } from '../format.js';
import { closest } from '../runs.js';
import { createChart } from '../plots/chart.js';
import { distancePlotsOf } from '../plots/distances.js';
import { distributionsOf } from '../plots/distributions.js';
import { plotsOfRun, plotsOfRuns } from '../plots/time_plots.js';
import { runAt, runsShown } from '../session.js';
import { groundOf } from '../theme.js';

const READ_EVERY = 120; // ms

/** Keeps a list of charts in step with what `plotsOf` gives. */
function chartSheet(store, keys, plotsOf, use, empty) {
  const sheet = element('div', { class: 'charts' });
  let charts = [];
  store.watch(keys, () => {
    charts.forEach((chart) => chart.dispose());
    charts = plotsOf().map((plot) => createChart(plot, {
      ...use,
      fold: { is: store.state.folded.has(plot.id), toggle: () => store.set({ folded: toggled(store.state.folded, plot.id) }) },
    }));
    const focused = document.activeElement?.closest?.('.chart')?.dataset.plot;
    sheet.replaceChildren(...(charts.length ? charts.map((chart) => chart.element) : [element('p', { class: 'muted', text: empty })]));
    if (focused) charts.find((chart) => chart.element.dataset.plot === focused)?.element.querySelector('.fold').focus();
  });
  store.watch(['highlight'], ({ highlight }) => charts.forEach((chart) => chart.highlight(highlight)));
  return { sheet, each: (act) => charts.forEach(act) };
}

export function createPlotSheet(report, store, player) {
  const single = report.kind === 'run';
  const xs = () => (single ? runAt(report, store.state).frames.seconds : runAt(report, store.state).frames.index);
  const keys = [...(single ? ['run'] : ['group', 'hidden', 'run']), 'theme', 'systemTheme', 'folded'];
  const { sheet, each } = chartSheet(store, keys,
    () => (single ? plotsOfRun(runAt(report, store.state)) : plotsOfRuns(runsShown(report, store.state, groundOf(store.state)))),
    { pick: (x) => player.goTo(closest(xs(), x)), zoom: (span) => store.set({ zoom: span && usefulSpan(xs(), span) }) }, 'There is nothing to plot.');
  const all = button('', 'Show all of the drive (double click on a plot)', () => store.set({ zoom: null }), { class: 'zoomed' });
  store.watch([...keys, 'zoom'], ({ zoom }) => {
    all.hidden = zoom === null;
    all.textContent = zoom ? `${single ? 'Time' : 'Scans'} ${shortNumber(zoom[0])} to ${shortNumber(zoom[1])}${single ? ' s' : ''} · show all` : '';
    each((chart) => chart.setSpan(zoom));
  });
  let timer = 0;
  store.watch([...keys, 'frame'], (state) => {
    each((chart) => chart.setNow(xs()[state.frame] ?? null));
    // Cursors go along at once; the numbers as often as people can read them.
    timer ||= setTimeout(() => {
      timer = 0;
      each((chart) => chart.read());
    }, READ_EVERY);
  });
  return element('div', {}, all, sheet);
}

/** A stretch that holds some values at least; null where it is all there is. @param {number[]} xs ascending */
function usefulSpan(xs, [low, high]) {
  const least = xs.length > 4 ? (4 * (xs.at(-1) - xs[0])) / (xs.length - 1) : Infinity;
  if (high - low >= xs.at(-1) - xs[0]) return null;
  const middle = (low + high) / 2;
  const half = Math.max(high - low, least) / 2;
  const span = [Math.max(xs[0], middle - half), Math.min(xs.at(-1), middle + half)];
  return span[0] < span[1] && (span[0] > xs[0] || span[1] < xs.at(-1)) ? span : null;
}

/** Shows half (2) or double (0.5) the stretch of the drive, about the current frame. */
export function zoomAbout(report, store, factor) {
  const { frames } = runAt(report, store.state);
  const xs = report.kind === 'run' ? frames.seconds : frames.index;
  const now = xs[store.state.frame];
  if (now === undefined) return;
  const [low, high] = store.state.zoom ?? [xs[0], xs.at(-1)];
  const half = (high - low) / factor / 2;
  store.set({ zoom: usefulSpan(xs, [now - half, now + half]) });
}

/** Charts of whole runs: nothing in them goes with the current frame. */
function createWholeSheet(report, store, plotsOf) {
  const { sheet } = chartSheet(store, ['group', 'hidden', 'run', 'theme', 'systemTheme', 'folded'],
    () => plotsOf(report.kind === 'run'
      ? [{ index: store.state.run, run: runAt(report, store.state), colour: '--series-0', dash: false }]
      : runsShown(report, store.state, groundOf(store.state))),
    {}, 'There are no errors to show: no ground truth.');
  return sheet;
}

export const createDistributionSheet = (report, store) => createWholeSheet(report, store, distributionsOf);
export const createDistanceSheet = (report, store) => createWholeSheet(report, store, distancePlotsOf);
