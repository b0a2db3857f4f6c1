// What stands over and beside the live view.
import { colourings } from '../colour/colourings.js';
import { button, chooser, element, iconButton } from '../dom.js';
import { counted, shortNumber } from '../format.js';
import { CAMERAS, SIZE } from '../panels/toolbar.js';
import { createChart } from '../plots/chart.js';
import { otherTheme } from '../theme.js';
import { KEPT_SECONDS, troubles } from './history.js';

const SHORTEST_SECONDS = 10; // of the plots, at the beginning

const PHASES = {
  connecting: ['connecting', 'other', 'Connecting to the run …'],
  live: ['live', 'ok', 'Connected. Nothing has come yet: the run reads its first scans.'],
  ended: ['ended', 'other', 'The run has ended. This page waits for the next one.'],
  lost: ['no connection', 'lost', 'There is no connection to the run. This page tries again every two seconds.'],
};

/** The line on top: which run this is, whether it goes on, and what counts. */
export function createLiveHeader(store) {
  const title = element('h1', { text: 'Live view' });
  const badge = element('span', { class: 'badge', role: 'status' });
  const facts = element('dl', { class: 'headline' });
  store.watch(['name'], ({ name }) => {
    title.textContent = name || 'Live view';
    document.title = name ? `Live: ${name}` : 'Live view';
  });
  store.watch(['phase'], ({ phase }) => {
    const [text, look] = PHASES[phase];
    badge.textContent = text;
    badge.className = `badge ${look}`;
    badge.dataset.phase = phase;
  });
  store.watch(['state', 'rate'], ({ state, rate }) => {
    const rows = state ? [
      ['scans', rate === null ? '–' : `${shortNumber(rate, 2)}/s`],
      ['speed', `${shortNumber(state.speed)} m/s`],
      state.positionSigma === null ? null : ['translation ±', `${shortNumber(1000 * state.positionSigma)} mm`],
      state.latency === null ? null : ['latency', `${shortNumber(state.latency)} ms`],
      state.error === null ? null : ['from ground truth', `${shortNumber(state.error)} m`],
    ].filter(Boolean) : [];
    facts.replaceChildren(...rows.map(([name, value]) => element('div', {}, element('dt', { text: name }), element('dd', { text: value }))));
  });
  const theme = iconButton('theme', 'Light or dark', () => store.set({ theme: otherTheme(store.state) }));
  return element('header', { class: 'top' }, title, badge, facts, element('div', { class: 'top-actions' }, theme));
}

/** Colour, camera and point size. */
export function createLiveToolbar(store, view) {
  const known = colourings.filter(({ id }) => id !== 'residual'); // of which no message tells
  const colour = chooser('Colour', known.map(({ id, name }) => ({ value: id, text: name })), (value) => store.set({ colour: value, limit: null }));
  const cameras = CAMERAS.map(({ id, name, help }) => button(name, help.replace(/ \(.\)$/, ''), () => store.set({ camera: id })));
  const size = element('input', {
    type: 'range', min: SIZE.least, max: SIZE.most, step: SIZE.step, 'aria-label': 'Point size', on: { input: () => store.set({ size: Number(size.value) }) },
  });
  const pause = button('Pause', 'Keep the picture; the run goes on', () => store.set({ paused: !store.state.paused }));
  store.watch(['colour'], (state) => colour.set(state.colour));
  store.watch(['size'], (state) => { size.value = String(state.size); });
  store.watch(['paused'], ({ paused }) => pause.setAttribute('aria-pressed', String(paused)));
  store.watch(['camera'], ({ camera }) => cameras.forEach((entry, k) => entry.setAttribute('aria-pressed', String(CAMERAS[k].id === camera))));
  return element('div', { class: 'toolbar', role: 'toolbar', 'aria-label': 'View' },
    element('label', { class: 'field' }, element('span', { text: 'Colour' }), colour.element),
    element('div', { class: 'segments', role: 'group', 'aria-label': 'Camera' }, ...cameras),
    button('Reset', 'Reset camera', () => view.resetCamera()), pause,
    element('label', { class: 'field size' }, element('span', { text: 'Points' }), size));
}

/** Over the view: the scan, and what is wrong with it or with the connection. */
export function createLiveStatus(store) {
  const badge = element('span');
  const facts = element('span');
  const line = element('div', { class: 'status-line' }, facts, badge);
  const trouble = element('div', { class: 'status-trouble' });
  const note = element('div', { class: 'status-note', role: 'status' });
  store.watch(['state'], ({ state }) => {
    line.hidden = !state;
    trouble.hidden = !state?.reason || state.status === 'ok';
    if (!state) return;
    facts.textContent = `${counted(state.points, 'point')} · ${counted(state.objects, 'moving object')} · ${shortNumber(state.time)} ms`;
    badge.className = `badge ${['ok', 'degenerate', 'lost', 'first'].includes(state.status) ? state.status : 'other'}`;
    badge.textContent = state.status;
    trouble.textContent = state.reason.replaceAll('_', ' ');
  });
  store.watch(['phase', 'state', 'warning', 'paused'], ({ phase, state, warning, paused }) => {
    note.textContent = phase !== 'live' || !state ? PHASES[phase][2] : warning || (paused ? 'Paused: the run goes on.' : '');
    note.hidden = note.textContent === '';
  });
  return element('div', { class: 'status' }, line, trouble, note);
}

/** A line each; `sigma` names the column of its standard deviation. */
const PLOTS = [
  { id: 'speed', title: 'Speed', unit: 'm/s', of: 'speed', sigma: 'speedSigma' },
  { id: 'translation', title: 'Standard deviation, translation', unit: 'mm', of: 'positionSigma', scale: 1000 },
  { id: 'rotation', title: 'Standard deviation, rotation', unit: 'mdeg', of: 'rotationSigma', scale: 1000 },
  { id: 'objects', title: 'Moving objects', unit: '', of: 'objects', whole: true },
  { id: 'time', title: 'Time for a scan', unit: 'ms', of: 'time' },
  { id: 'latency', title: 'Latency', unit: 'ms', of: 'latency' },
  { id: 'error', title: 'Distance from the ground truth', unit: 'm', of: 'error' },
];

const scaled = (values, scale) => values.map((value) => (value === null ? null : scale * value));

/** Plots of the last minute; those of which nothing is told are not there. */
export function createLivePlots(store, history) {
  const charts = PLOTS.map(({ id, title, unit, whole, of, sigma, scale = 1 }) => {
    const series = { name: '', colour: '--series-0', xs: [], ys: [] };
    const plot = { id, title, unit, y: { fromZero: true, whole }, xName: 'time (s)', x: { low: 0, high: KEPT_SECONDS }, marks: [], series: [series] };
    const chart = createChart(plot);
    chart.element.querySelector('canvas').setAttribute('aria-label', `${title}${unit ? ` in ${unit}` : ''} over the last minute`);
    chart.element.hidden = true;
    return { plot, series, chart, of, sigma, scale };
  });
  return {
    element: element('section', { class: 'side', 'aria-label': 'Plots' }, element('div', { class: 'sheet charts' }, ...charts.map(({ chart }) => chart.element))),
    draw() {
      const last = history.seconds.at(-1) ?? 0;
      const high = Math.max(SHORTEST_SECONDS, last);
      const marks = troubles(history);
      for (const { plot, series, chart, of, sigma, scale } of charts) {
        Object.assign(plot, { x: { low: Math.max(0, high - KEPT_SECONDS), high }, marks });
        Object.assign(series, { xs: history.seconds, ys: scaled(history[of], scale), sigma: sigma && scaled(history[sigma], scale) });
        chart.element.hidden = series.ys.every((value) => value === null);
        chart.draw();
        chart.setNow(last);
        chart.read();
      }
    },
  };
}
