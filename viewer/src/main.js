// The page: reads what it holds, puts the panels together, keeps the address in step.
import './style/base.css';
import './style/layout.css';
import './style/panels.css';
import { usualLimits } from './colour/colourings.js';
import { element } from './dom.js';
import { keyBindings, listenToKeys } from './keys.js';
import { usualLayers } from './layers.js';
import { readReport } from './page_data.js';
import { createComparisonSheet, createRunChips, createTableSheet } from './panels/comparison.js';
import { createHeader, firstRun } from './panels/header.js';
import { createHelp } from './panels/help.js';
import { createLegend, createPointReading } from './panels/legend.js';
import { createObjectCard, createObjectSheet } from './panels/objects.js';
import { createDistanceSheet, createDistributionSheet, createPlotSheet } from './panels/plots.js';
import { createRankings } from './panels/ranking.js';
import { createStatus } from './panels/status.js';
import { createConfigurationSheet, createSummarySheet } from './panels/summary.js';
import { createTabs } from './panels/tabs.js';
import { createTimeline } from './panels/timeline.js';
import { createToolbar } from './panels/toolbar.js';
import { createWorstFrames } from './panels/worst_frames.js';
import { createPlayer } from './player.js';
import { createFlatMap } from './plots/flat_map.js';
import { lastFrame } from './runs.js';
import { createView } from './scene/view.js';
import { firstFrame, fitState, runAt } from './session.js';
import { keptKeys, readFragment, writeFragment } from './state.js';
import { createStore } from './store.js';
import { followTheme } from './theme.js';

const PICTURE_WITHIN = 3000; // ms; without one, say in a window nobody sees, the page goes on

/** Ablations are many and much alike: they are shown when they are asked for, unless there is nothing else. */
function ablationsOf(report) {
  const isAblation = (run) => run.facts.some(([name, value]) => name === 'ablation' && value !== 'none');
  const found = report.runs.map((_, k) => k).filter((k) => isAblation(report.runs[k]));
  return new Set(found.length < report.runs.length ? found : []);
}

/** What a page shows when its address says nothing. */
function usualState(report) {
  const run = firstRun(report, 0);
  return {
    group: 0, run, frame: report.kind === 'run' ? firstFrame(report.runs[run]) : lastFrame(report.runs[run]),
    colour: 'compensated', limit: null, layers: report.kind === 'run' ? usualLayers() : new Set(['path', 'truth']),
    camera: report.kind === 'run' ? 'follow' : 'top', eye: null, size: 2.5, speed: 1,
    tab: 'plots', hidden: ablationsOf(report), theme: null,
    object: null, chase: false, zoom: null, folded: new Set(),
  };
}

function sheetsOf(report, store, player) {
  const single = report.kind === 'run';
  const hasTruth = report.runs.some((run) => run.stretches);
  const hasObjects = single && report.runs[0].frames.objects.some((list) => list.length > 0);
  return [
    { id: 'plots', name: 'Plots', create: () => createPlotSheet(report, store, player) },
    hasObjects && { id: 'objects', name: 'Objects', create: () => createObjectSheet(report, store, player) },
    hasTruth && { id: 'distance', name: 'Distance', create: () => createDistanceSheet(report, store) },
    { id: 'distributions', name: 'CDF', create: () => createDistributionSheet(report, store) },
    { id: 'summary', name: single ? 'Summary' : 'Run', create: () => createSummarySheet(report, store) },
    { id: 'configuration', name: 'Settings', create: () => createConfigurationSheet(report, store) },
  ].filter(Boolean);
}

/** Keeps the address in step with the state, not more often than browsers allow. */
function keepAddress(store, usual) {
  let timer = 0;
  const write = () => {
    const fragment = `#${writeFragment(store.state, usual)}`;
    if (fragment === location.hash) return;
    try {
      history.replaceState(null, '', fragment);
    } catch {
      // Some browsers allow no history for files; the link button still works.
    }
  };
  store.watch(keptKeys, () => {
    clearTimeout(timer);
    timer = setTimeout(write, 250);
  });
}

function show(page) {
  document.getElementById('app').replaceChildren(page);
  document.body.classList.add('with-viewer');
}

/** What is decided by where runs are compared comes first, as wide as the page. */
const createResults = (report, store) => element('section', { class: 'results', 'aria-label': 'Tables and rankings' },
  report.tables?.length ? createTableSheet(report) : null, createComparisonSheet(report, store),
  element('div', { class: 'findings' }, createRankings(report, store), createWorstFrames(report, store)));

/** A benchmark of which nothing but its tables is left. */
const pageWithoutRuns = (report) => element('div', {},
  element('header', { class: 'top' }, element('h1', { text: report.title })),
  report.tables?.length ? createTableSheet(report) : element('p', { class: 'text-sheet', text: 'This page holds no run.' }),
  element('ul', { class: 'notes text-sheet' }, ...report.notes.map((text) => element('li', { text }))));

function start() {
  const report = readReport();
  if (report.runs.length === 0) {
    show(pageWithoutRuns(report));
    return;
  }
  const usual = usualState(report);
  const fromLink = fitState(report, { ...usual, ...readFragment(location.hash) });
  const store = createStore({ ...fromLink, systemTheme: 'light', playing: false, shown: null, picked: null, limits: {}, measuring: false, ruler: [], highlight: null });
  store.watch(['run'], (state) => store.set({ limits: usualLimits(runAt(report, state)) }));
  store.watch(['group', 'run'], (state) => {
    const { frame, object, chase } = fitState(report, state);
    store.set({ frame, object, chase });
  });
  followTheme(store);

  const player = createPlayer(report, store);
  const view = createView(report, store) ?? createFlatMap(report, store);
  const showHelp = () => help.showModal();
  const bindings = keyBindings(report, store, player, view, showHelp);
  const help = createHelp(bindings);
  const link = () => `${location.href.split('#')[0]}#${writeFragment(store.state, usual)}`;
  const stage = element('div', { class: 'stage' }, view.element,
    createStatus(report, store), createLegend(report, store),
    element('div', { class: 'readings' }, createPointReading(store), createObjectCard(report, store)));
  store.watch(['camera'], ({ camera }) => stage.classList.toggle('from-above', camera === 'top'));
  const single = report.kind === 'run';
  const tabs = createTabs(store, sheetsOf(report, store, player));
  const page = element('div', { class: single ? 'page' : 'page several' },
    createHeader(report, store, { showHelp, link }),
    single ? null : createResults(report, store),
    element('main', { class: 'columns' },
      element('section', { class: 'view', 'aria-label': 'View' },
        createToolbar(report, store, view), report.kind === 'run' ? null : createRunChips(report, store),
        stage, createTimeline(report, store, player)),
      tabs.element),
    help);
  show(page);
  // The picture first: what takes time beside it is made once it stands.
  Promise.race([view.start(), new Promise((done) => { setTimeout(done, PICTURE_WITHIN); })]).then(tabs.fill);
  listenToKeys(bindings);
  keepAddress(store, usual);
  // Only a reader changes the fragment in a way that is told: another link, which is opened as if it were new.
  window.addEventListener('hashchange', () => location.reload());
}

try {
  start();
} catch (error) {
  // What the page holds without the viewer stays readable.
  document.getElementById('app')?.prepend(element('p', { class: 'failure', role: 'alert', text: `The interactive view did not start: ${error.message}` }));
  console.error(error);
}
