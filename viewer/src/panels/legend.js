// What the colours mean: with numbers, units, and buttons for a narrower or wider range.
import { UNKNOWN } from '../bytes.js';
import { colouring, nextLimit } from '../colour/colourings.js';
import { gradient, markColours } from '../colour/maps.js';
import { button, element, put } from '../dom.js';
import { shortNumber } from '../format.js';
import { MOST_CROSSES } from '../scene/predicted_points.js';
import { runAt } from '../session.js';
import { groundOf } from '../theme.js';

const entry = (colour, text, shape = '') => {
  const swatch = element('i', { class: `mark ${shape}` });
  swatch.style.setProperty('--swatch', colour);
  return element('span', { class: 'legend-entry' }, swatch, element('span', { text }));
};

/** The limit of the current colouring moved by some steps. */
export function changeLimit(store, steps) {
  const { colour, limit, limits } = store.state;
  if (colouring(colour).map === 'categories') return;
  store.set({ limit: nextLimit(limit ?? limits[colour], steps) });
}

function scaleBar(store, chosen, ground) {
  const { limit, limits } = store.state;
  const most = limit ?? limits[chosen.id];
  const ends = chosen.map === 'diverging' ? [-most, 0, most] : [0, most / 2, most];
  const bar = element('div', { class: 'legend-bar' });
  bar.style.background = gradient(chosen.map, ground);
  const signed = (value) => (chosen.map === 'diverging' && value > 0 ? `+${shortNumber(value)}` : shortNumber(value));
  return element('div', { class: 'legend-scale' },
    button('−', 'Narrower range of colours ([)', () => changeLimit(store, -1)),
    element('div', { class: 'legend-axis' }, bar,
      element('div', { class: 'legend-ticks' }, ...ends.map((value) => element('span', { text: signed(value) }))),
      chosen.id === 'compensated' ? element('div', { class: 'legend-hint', text: 'approaching ← static → receding' }) : null),
    button('+', 'Wider range of colours (])', () => changeLimit(store, 1)));
}

export function createLegend(report, store) {
  const legend = element('div', { class: 'legend' });
  store.watch(['colour', 'limit', 'limits', 'layers', 'theme', 'systemTheme', 'run'], (state) => {
    const run = runAt(report, state);
    const ground = groundOf(state);
    const chosen = colouring(state.colour);
    const marks = markColours(ground);
    const parts = [];
    if (run.scans) {
      parts.push(element('div', { class: 'legend-title', title: chosen.meaning },
        chosen.unit ? `${chosen.name} (${chosen.unit})` : chosen.name));
      if (chosen.map === 'categories') {
        parts.push(element('div', { class: 'legend-entries' }, entry(marks.still, 'static'), entry(marks.moving, 'moving, no object'),
          entry(marks.unused, 'not used'), element('span', { class: 'legend-entry', text: 'objects: a colour each' })));
      } else {
        parts.push(scaleBar(store, chosen, ground));
        if (chosen.id === 'residual') parts.push(element('div', { class: 'legend-entries' }, entry(marks.unknown, 'no surface near')));
      }
      if (state.layers.has('predicted')) {
        parts.push(element('div', { class: 'legend-entries' }, entry(marks.measured, 'object points, measured'),
          entry(marks.predicted, `at the next scan (up to ${MOST_CROSSES} an object)`, 'cross')));
      }
    }
    if (run.frames.object_details && state.layers.has('arrows')) {
      parts.push(element('div', { class: 'legend-hint', text: 'dashed, ~: tangential speed not observed' }));
    }
    if (run.traces && state.layers.has('traces') && chosen.map !== 'categories') {
      parts.push(element('div', { class: 'legend-entries' }, entry(marks.moving, 'moving points of the drive')));
    }
    if (run.truth && state.layers.has('truth')) parts.push(element('div', { class: 'legend-entries' }, entry('var(--ink)', 'ground truth', 'band')));
    legend.replaceChildren(...parts);
    legend.hidden = parts.length === 0;
  });
  return legend;
}

const known = (value, unit) => (value <= UNKNOWN / 2 ? 'unknown' : `${shortNumber(value)} ${unit}`);

/** What is known of a point that was clicked. */
export function createPointReading(store) {
  const reading = element('div', { class: 'point-reading', role: 'status' });
  store.watch(['picked', 'frame', 'run'], ({ picked }, changed) => {
    if (picked && !changed.includes('picked')) {
      store.set({ picked: null }); // it was a point of another scan
      return;
    }
    put(reading, 'hidden', !picked);
    if (!picked) return;
    const kind = picked.object !== null ? `object ${picked.object}` : ['not used', 'static', 'moving'][picked.label] ?? 'moving';
    const rows = [
      ['point', `${picked.place.map((value) => value.toFixed(2)).join('  ')} m`],
      ['range', `${shortNumber(Math.hypot(...picked.place), 4)} m`],
      ['Doppler', known(picked.doppler, 'm/s')],
      ['ego-motion compensated', known(picked.compensated, 'm/s')],
      ['residual', known(picked.residual, 'm')],
      ['class', kind],
    ];
    reading.replaceChildren(...rows.map(([name, value]) =>
      element('div', {}, element('span', { text: name }), element('b', { text: value }))));
  });
  return reading;
}
