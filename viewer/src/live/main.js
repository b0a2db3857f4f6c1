// The page that shows a run while it goes on: listens to the server that it came from and draws what comes.
import '../style/base.css';
import '../style/layout.css';
import '../style/panels.css';
import { usualLimits } from '../colour/colourings.js';
import { element } from '../dom.js';
import { createLegend } from '../panels/legend.js';
import { onNextFrame } from '../scene/context.js';
import { createStore } from '../store.js';
import { followTheme } from '../theme.js';
import { connect } from './connection.js';
import { append, clear, createHistory } from './history.js';
import { createLiveHeader, createLivePlots, createLiveStatus, createLiveToolbar } from './live_panels.js';
import { createLiveView } from './live_view.js';
import { decodeCloud, decodeObjects, decodePath, decodeState, decodeTransforms } from './messages.js';

const PLOTS_APART = 250; // ms
const POSES_KEPT = 64; // of scans whose points may still come
const WARNING_SHOWN = 5000; // ms
const RATE_OVER = 20; // scans
const SMALL_TOPICS = ['/tf', '/path', '/objects', '/odometry/state', '/ground_truth/path'];

const USUAL = { compensated: 5, doppler: 5, kind: 1, residual: 0.2, height: 10 };

/** What the legend asks of a run. */
const legendRun = { scans: {}, frames: { object_details: {} }, traces: null, truth: null };

function start() {
  const store = createStore({
    name: '', phase: 'connecting', state: null, rate: null, warning: '', paused: false,
    colour: 'compensated', limit: null, limits: USUAL, camera: 'follow', size: 2.5, layers: new Set(['arrows', 'truth']),
    run: 0, theme: null, systemTheme: 'light',
  });
  followTheme(store);
  const history = createHistory();
  const view = createLiveView(store);
  const plots = createLivePlots(store, history);
  const poses = new Map(); // by stamp
  let session = null;
  let first = null; // stamp, ns
  let arrivals = []; // s, of the last scans, by the clock of the browser
  let pending = {}; // what came and is not yet drawn
  let warningTimer = 0;
  let plotTimer = 0;

  const fail = (text) => {
    clearTimeout(warningTimer);
    store.set({ warning: text });
    warningTimer = setTimeout(() => store.set({ warning: '' }), WARNING_SHOWN);
  };

  function forget() {
    poses.clear();
    clear(history);
    [first, pending, arrivals] = [null, {}, []];
    legendRun.truth = null;
    store.set({ state: null, rate: null, limits: { ...USUAL } });
    view?.clear();
  }

  /** Colours reach as far as what was seen; they never shrink, or they would flicker. */
  function widenLimits(state, objects) {
    const rows = objects.map(({ id, velocity, centre }) => [id, ...velocity, ...centre]);
    const seen = usualLimits({ frames: { index: [0], ego_velocity: state.velocity, objects: [rows] } });
    const { limits } = store.state;
    const wider = { ...limits, compensated: Math.max(limits.compensated, seen.compensated), doppler: Math.max(limits.doppler, seen.doppler) };
    if (wider.compensated > limits.compensated || wider.doppler > limits.doppler) store.set({ limits: wider });
  }

  const draw = onNextFrame(() => {
    if (store.state.paused) return;
    const { cloud, path, truth, objects, state } = pending;
    const pose = state && poses.get(state.stamp);
    pending = {};
    try {
      if (truth) {
        legendRun.truth = {};
        store.set({ layers: new Set(store.state.layers) }); // the legend has one thing more
        view?.showTruth(decodePath(truth.message));
      }
      if (path) view?.showPath(decodePath(path.message));
      const list = objects ? decodeObjects(objects.message) : [];
      if (state) widenLimits(state.value, list);
      const scanPose = cloud && poses.get(cloud.stamp);
      const scan = scanPose ? decodeCloud(cloud.message) : null;
      if (pose) view?.show({ scan, scanPose, objects: list, state: state.value, pose });
    } catch (error) {
      fail(`a message cannot be read: ${error.message}`);
    }
  });

  function takeState(stamp, message) {
    const value = decodeState(message);
    first ??= stamp;
    append(history, Number(stamp - first) / 1e9, value);
    arrivals.push(performance.now() / 1000);
    if (arrivals.length > RATE_OVER) arrivals.shift();
    const rate = arrivals.length > 1 ? (arrivals.length - 1) / (arrivals.at(-1) - arrivals[0]) : null;
    pending.state = { stamp, value };
    if (!store.state.paused) store.set({ state: value, rate });
    plotTimer ||= setTimeout(() => {
      plotTimer = 0;
      if (!store.state.paused) plots.draw();
    }, PLOTS_APART);
  }

  function take(topic, stamp, message) {
    if (topic === '/tf') {
      const pose = decodeTransforms(message);
      if (pose) poses.set(stamp, pose);
      if (poses.size > POSES_KEPT) poses.delete(poses.keys().next().value);
    } else if (topic === '/odometry/state') {
      takeState(stamp, message);
      draw(); // the last message of a scan
    } else {
      pending[{ '/points': 'cloud', '/path': 'path', '/objects': 'objects', '/ground_truth/path': 'truth' }[topic]] = { stamp, message };
    }
  }

  const stage = element('div', { class: 'stage' },
    view?.element ?? element('p', { class: 'scene-note', text: 'The 3D view needs WebGL 2, which this browser does not offer; all numbers are here.' }),
    createLiveStatus(store), createLegend({ runs: [legendRun] }, store));
  store.watch(['camera'], ({ camera }) => stage.classList.toggle('from-above', camera === 'top'));
  document.getElementById('app').replaceChildren(element('div', { class: 'page' },
    createLiveHeader(store),
    element('main', { class: 'columns' },
      element('section', { class: 'view', 'aria-label': 'View' }, view ? createLiveToolbar(store, view) : null, stage),
      plots.element)));
  document.body.classList.add('with-viewer');
  view?.start();

  const { protocol, host } = location;
  const connection = connect(`${protocol === 'https:' ? 'wss:' : 'ws:'}//${host}/`, {
    phase: (phase) => store.set({ phase }),
    server: ({ name, sessionId }) => {
      if (session !== sessionId) forget();
      session = sessionId;
      store.set({ name });
    },
    warning: fail,
    message: take,
    // Points are many: nobody sees them in a hidden page or in a picture that stands.
    topics: () => (document.hidden || store.state.paused || !view ? SMALL_TOPICS : [...SMALL_TOPICS, '/points']),
  });
  document.addEventListener('visibilitychange', connection.subscribe);
  store.watch(['theme', 'systemTheme'], plots.draw);
  store.watch(['paused'], ({ paused }) => {
    connection.subscribe();
    if (!paused) plots.draw();
  });
}

start();
