// The moving objects: a card over the view about the selected one, and a sheet with its plot and the tracks of the run.
import { button, element } from '../dom.js';
import { counted, grouped, shortNumber } from '../format.js';
import { createChart } from '../plots/chart.js';
import { runAt } from '../session.js';
import { headingInWorld, nearestOf, speedPlotOf, summaryOf, tracksOf } from '../tracks.js';

const UPDATE_EVERY = 120; // ms
const withSigma = (value, sigma, unit) =>
  (value === null ? 'unknown' : `${shortNumber(value)}${sigma === null || sigma === undefined ? '' : ` ± ${shortNumber(sigma, 1)}`}${unit}`);
const sizeText = (extent) => extent.map((value) => value.toFixed(1)).join(' × ');

/** What is known of an object at a frame, as rows. @param {ReturnType<typeof nearestOf>} object */
export function factsOf(run, object, track) {
  const { details } = object;
  const facesThat = (wanted) => details.faces.filter(({ view }) => view === wanted).map(({ face }) => face).join(', ') || 'none';
  return [
    ['speed', withSigma(object.speed, details?.speedSigma, ' m/s')],
    ['heading', withSigma(headingInWorld(run, object.frame, object), details?.headingSigma, '°')],
    ['size', `${sizeText(object.extent)} m`],
    ['range', `${shortNumber(Math.hypot(...object.centre))} m`],
    ['points', grouped(object.points)],
    ['seen in', counted(track.frames.length, 'scan')],
    ...(details ? [
      ['age', counted(details.age, 'scan')],
      ['tangential speed', details.observed ? 'observed' : 'not observed (~)'],
      ['sigma radial, tangential', `${shortNumber(details.radialSigma, 2)}, ${shortNumber(details.tangentialSigma, 2)} m/s`],
      ['sigma of the centre', `${shortNumber(details.centreSigma, 2)} m`],
      ['faces seen', facesThat('seen')],
      ['faces hidden', facesThat('hidden')],
    ] : []),
  ];
}

/** The ids of a frame's objects, near ones first: the order in which keys go through them. */
function idsByRange(run, frame) {
  const list = run.frames.objects[frame] ?? [];
  return [...list].sort((a, b) => Math.hypot(a[4], a[5], a[6]) - Math.hypot(b[4], b[5], b[6])).map(([id]) => id);
}

/** Selects the next (1) or previous (-1) object of the frame, the nearest at first. */
export function selectNext(report, store, step) {
  const ids = idsByRange(runAt(report, store.state), store.state.frame);
  if (ids.length === 0) return;
  const at = ids.indexOf(store.state.object);
  store.set({ object: at < 0 ? ids.at(step > 0 ? 0 : -1) : ids[(at + step + ids.length) % ids.length], picked: null });
}

/** Lets the camera go with the selected object, or with the sensor again. */
export function toggleChase(store) {
  const { object, chase, camera } = store.state;
  if (object !== null) store.set({ chase: !chase, camera: camera === 'free' ? 'follow' : camera });
}

function followButton(store, properties = {}) {
  const made = button('Follow', 'Camera follows this object (W)', () => toggleChase(store), properties);
  store.watch(['chase'], ({ chase }) => made.setAttribute('aria-pressed', String(chase)));
  return made;
}

const deselect = (store) => store.set({ object: null, chase: false, picked: null });
const pairs = (rows) => rows.map(([name, value]) => element('div', {}, element('span', { text: name }), element('b', { text: value })));

/** Acts after the frame changed, not more often than people can read. */
function whenRead(store, keys, act) {
  let timer = 0;
  store.watch(keys, (state, changed) => {
    if (changed.length === 1 && changed[0] === 'frame') {
      timer ||= setTimeout(() => {
        timer = 0;
        act(store.state);
      }, UPDATE_EVERY);
    } else {
      act(state);
    }
  });
}

const isThere = (track, frame) => track.frames.includes(frame);

export function createObjectCard(report, store) {
  const title = element('b');
  const rows = element('div');
  const card = element('div', { class: 'object-card', role: 'status', 'aria-label': 'Selected object' },
    element('div', { class: 'object-title' }, title, followButton(store),
      button('Track', 'Plot of its speed and all tracks', () => store.set({ tab: 'objects' })),
      button('×', 'Select nothing (Esc)', () => deselect(store))), rows);
  whenRead(store, ['object', 'frame', 'run'], ({ object, frame, ...state }) => {
    const run = runAt(report, state);
    const track = object === null ? null : tracksOf(run).get(object);
    card.hidden = !track;
    if (!track) return;
    const nearest = nearestOf(run, track, frame);
    title.textContent = `Object ${object}${nearest.frame === frame ? '' : `, as in frame ${nearest.frame}`}`;
    rows.replaceChildren(...pairs(factsOf(run, nearest, track).slice(0, 8)));
  });
  return card;
}

const COLUMNS = [
  { id: 'id', name: 'id', help: 'Number of the track', text: ({ id }) => String(id) },
  { id: 'from', name: 'frames', help: 'First and last frame', text: ({ from, to }) => `${from}–${to}` },
  { id: 'scans', name: 'scans', help: 'In how many scans it is', text: ({ scans }) => String(scans) },
  { id: 'speed', name: 'm/s', help: 'Median speed and its standard deviation', text: ({ speed, speedSigma }) => withSigma(speed, speedSigma, '') },
  { id: 'heading', name: '°', help: 'Heading in the middle of the track, from the x axis counterclockwise', text: ({ heading }) => shortNumber(heading) },
  { id: 'length', name: 'size (m)', help: 'Length × width × height at its last scan', text: ({ extent }) => sizeText(extent) },
  { id: 'range', name: 'm', help: 'Smallest range', text: ({ range }) => shortNumber(range) },
  { id: 'observed', name: 'tang.', help: 'Share of its scans in which the tangential speed was observed', text: ({ observed }) => (observed === null ? '–' : `${Math.round(100 * observed)} %`) },
  { id: 'facesSeen', name: 'faces', help: 'Faces of its box seen by its last scan, of 6', text: ({ facesSeen }) => (facesSeen === null ? '–' : String(facesSeen)) },
];

function createTrackTable(report, store, select) {
  const body = element('tbody');
  let order = { by: 'scans', down: true };
  let rows = new Map();
  let all = [];
  const value = (row, by) => (by === 'length' ? row.extent[0] : row[by]) ?? -Infinity;
  const heads = COLUMNS.map(({ id, name, help }) => element('th', { scope: 'col' },
    button(name, `${name}: ${help}; sort by it`, () => {
      order = { by: id, down: order.by === id ? !order.down : id !== 'id' && id !== 'from' };
      arrange();
    })));
  function arrange() {
    const sign = order.down ? -1 : 1;
    all.sort((a, b) => sign * (value(a, order.by) - value(b, order.by)) || a.id - b.id);
    body.replaceChildren(...all.map(({ id }) => rows.get(id)));
    heads.forEach((head, k) => {
      if (COLUMNS[k].id === order.by) head.setAttribute('aria-sort', order.down ? 'descending' : 'ascending');
      else head.removeAttribute('aria-sort');
    });
  }
  store.watch(['run'], (state) => {
    const run = runAt(report, state);
    all = [...tracksOf(run).values()].map((track) => summaryOf(run, track));
    rows = new Map(all.map((row) => [row.id, element('tr', { on: { click: () => select(row.id) } },
      element('th', { scope: 'row' }, element('button', { type: 'button', text: COLUMNS[0].text(row), 'aria-label': `Object ${row.id}` })),
      ...COLUMNS.slice(1).map(({ text }) => element('td', { text: text(row) })))]));
    arrange();
  });
  const table = element('table', { class: 'tracks' }, element('thead', {}, element('tr', {}, ...heads)), body);
  body.addEventListener('keydown', (event) => {
    const step = { ArrowDown: 'nextElementSibling', ArrowUp: 'previousElementSibling' }[event.key];
    const next = step && event.target.closest('tr')?.[step];
    if (!next) return;
    event.preventDefault();
    next.querySelector('button').focus();
  });
  let marked = [];
  whenRead(store, ['frame', 'run', 'object'], ({ frame, object, ...state }) => {
    for (const row of marked) row.className = '';
    marked = (runAt(report, state).frames.objects[frame] ?? []).map(([id]) => rows.get(id)).filter(Boolean);
    for (const row of marked) row.className = 'here';
    for (const [id, row] of rows) {
      const name = row.querySelector('button');
      if ((name.getAttribute('aria-pressed') === 'true') !== (id === object)) name.setAttribute('aria-pressed', String(id === object));
      row.classList.toggle('chosen', id === object);
    }
  });
  return table;
}

export function createObjectSheet(report, store, player) {
  const hint = element('p', { class: 'muted', text: 'Select an object: click it in the view or its row below, or press X.' });
  const heading = element('h2');
  const rows = element('div', { class: 'object-facts' });
  const plot = element('div');
  const chosen = element('section', {}, element('div', { class: 'object-title' }, heading, followButton(store),
    button('Deselect', 'Select nothing (Esc)', () => deselect(store))), plot, rows);
  let chart = null;
  const trackOf = (state) => (state.object === null ? null : tracksOf(runAt(report, state)).get(state.object) ?? null);

  store.watch(['object', 'run', 'theme', 'systemTheme'], (state) => {
    const track = trackOf(state);
    chart?.dispose();
    chart = null;
    [hint.hidden, chosen.hidden] = [track !== null, track === null];
    if (!track) return;
    const { seconds } = runAt(report, state).frames;
    chart = createChart(speedPlotOf(runAt(report, state), track), {
      pick: (x) => player.goTo(track.frames.reduce((best, frame) => (Math.abs(seconds[frame] - x) < Math.abs(seconds[best] - x) ? frame : best))),
    });
    plot.replaceChildren(chart.element);
  });
  whenRead(store, ['object', 'frame', 'run', 'theme', 'systemTheme'], (state) => {
    const track = trackOf(state);
    if (!track) return;
    const run = runAt(report, state);
    const nearest = nearestOf(run, track, state.frame);
    heading.textContent = `Object ${state.object}${nearest.frame === state.frame ? '' : `, as in frame ${nearest.frame}`}`;
    rows.replaceChildren(...pairs(factsOf(run, nearest, track)));
    chart?.setNow(run.frames.seconds[state.frame] ?? null);
    chart?.read();
  });
  const select = (id) => {
    const track = tracksOf(runAt(report, store.state)).get(id);
    const { frame } = store.state;
    store.set({ object: id, picked: null });
    if (!isThere(track, frame)) player.goTo(nearestOf(runAt(report, store.state), track, frame).frame);
  };
  return element('div', { class: 'text-sheet' }, hint, chosen,
    element('section', {}, element('h2', { text: 'Tracks of the run' }),
      element('div', { class: 'scroll' }, createTrackTable(report, store, select)),
      element('p', { class: 'muted', text: '● in the frame shown' })));
}
