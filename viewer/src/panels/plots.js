// The sheet of plots over the drive, and the one of distributions.
import { element } from '../dom.js';
import { closest } from '../runs.js';
import { createChart } from '../plots/chart.js';
import { distributionsOf } from '../plots/distributions.js';
import { plotsOfRun, plotsOfRuns } from '../plots/time_plots.js';
import { runAt, runsShown } from '../session.js';
import { groundOf } from '../theme.js';

const READ_EVERY = 120; // ms

/** Keeps a list of charts in step with what `plotsOf` gives. */
function chartSheet(store, keys, plotsOf, pick, empty) {
  const sheet = element('div', { class: 'charts' });
  let charts = [];
  store.watch(keys, () => {
    charts.forEach((chart) => chart.dispose());
    charts = plotsOf().map((plot) => createChart(plot, pick));
    sheet.replaceChildren(...(charts.length ? charts.map((chart) => chart.element) : [element('p', { class: 'muted', text: empty })]));
  });
  return { sheet, each: (act) => charts.forEach(act) };
}

export function createPlotSheet(report, store, player) {
  const single = report.kind === 'run';
  const xs = () => (single ? runAt(report, store.state).frames.seconds : runAt(report, store.state).frames.index);
  const keys = single ? ['run', 'theme', 'systemTheme'] : ['group', 'hidden', 'run', 'theme', 'systemTheme'];
  const { sheet, each } = chartSheet(store, keys,
    () => (single ? plotsOfRun(runAt(report, store.state)) : plotsOfRuns(runsShown(report, store.state, groundOf(store.state)))),
    (x) => player.goTo(closest(xs(), x)), 'There is nothing to plot.');
  let timer = 0;
  store.watch([...keys, 'frame'], (state) => {
    each((chart) => chart.setNow(xs()[state.frame] ?? null));
    // Cursors go along at once; the numbers as often as people can read them.
    timer ||= setTimeout(() => {
      timer = 0;
      each((chart) => chart.read());
    }, READ_EVERY);
  });
  return sheet;
}

export function createDistributionSheet(report, store) {
  const { sheet } = chartSheet(store, ['group', 'hidden', 'run', 'theme', 'systemTheme'],
    () => distributionsOf(report.kind === 'run'
      ? [{ run: runAt(report, store.state), colour: '--series-0' }]
      : runsShown(report, store.state, groundOf(store.state))),
    undefined, 'There are no errors to show: no ground truth.');
  return sheet;
}
