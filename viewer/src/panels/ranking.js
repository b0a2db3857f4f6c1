// Ranked bars: a row a run, the best one on top, with how far its number spreads.
import { element } from '../dom.js';
import { shortNumber, withUnit } from '../format.js';
import { rankingsOf } from '../plots/ranking.js';
import { createScale, tickText } from '../plots/scale.js';
import { runsShown } from '../session.js';
import { groundOf } from '../theme.js';

const TICKS = 4;

/** From values to percent of the width. */
function scaleOf({ log, rows }) {
  const values = rows.flatMap(({ value, spread, drives }) => [value, ...(spread ?? []), ...drives.map((drive) => drive.value)])
    .filter((value) => value !== null && (!log || value > 0));
  const most = Math.max(...values);
  return createScale({ low: log ? Math.min(...values) / 1.15 : 0, high: (log ? 1.15 : 1.03) * most || 1, from: 0, to: 100, log });
}

const at = (name, style) => {
  const made = element('i', { class: name });
  Object.assign(made.style, style);
  return made;
};

function bar({ value, spread, drives, colour, dash }, { log }, scale) {
  if (value === null) return element('div', { class: 'bar' });
  const from = (low, high) => ({ left: `${scale.place(low)}%`, width: `${scale.place(high) - scale.place(low)}%` });
  // A bar begins at zero, which a logarithm does not know: there a mark stands alone.
  const made = element('div', { class: dash ? 'bar dash' : 'bar', 'aria-hidden': 'true' },
    log ? at('bar-mark', { left: `${scale.place(value)}%` }) : at('bar-length', from(0, value)),
    spread ? at('bar-spread', from(...spread)) : null,
    ...(drives.length > 1 ? drives.map((drive) => at('bar-drive', { left: `${scale.place(drive.value)}%` })) : []));
  made.style.setProperty('--swatch', colour);
  return made;
}

function axis({ unit }, scale) {
  const ticks = scale.ticks(TICKS);
  const marks = ticks.map((tick) => {
    const mark = at('bar-tick', { left: `${scale.place(tick)}%` });
    mark.textContent = tickText(tick, ticks);
    return mark;
  });
  return element('div', { class: 'bar-axis', 'aria-hidden': 'true' }, element('span', {}), element('div', { class: 'bar-ticks' }, ...marks), element('span', { class: 'bar-unit', text: unit }));
}

/** What a row says when it is read out or pointed at. */
function spokenOf({ name, value, spread, drives }, unit) {
  if (value === null) return `${name}: no value`;
  const apart = spread ? `, ${shortNumber(spread[0])} to ${withUnit(spread[1], unit)}` : '';
  const each = drives.length > 1 ? ` (${drives.map(({ drive, value: one }) => `${drive} ${shortNumber(one)}`).join(', ')})` : '';
  return `${name}: ${withUnit(value, unit)}${apart}${each}`;
}

function figureOf(ranking, store) {
  const scale = scaleOf(ranking);
  const highlight = (index) => () => store.set({ highlight: index });
  return element('figure', { class: 'ranking', data: { ranking: ranking.id } },
    element('figcaption', {}, element('b', { text: ranking.title }), element('span', { class: 'muted', text: ` ${ranking.unit}${ranking.log ? ', logarithmic' : ''}` })),
    element('ol', {}, ...ranking.rows.map((row) => element('li', {
      title: spokenOf(row, ranking.unit), data: { run: row.index },
      on: { pointerenter: highlight(row.index), pointerleave: highlight(null) },
    },
    element('span', { class: 'bar-name', text: row.name }), bar(row, ranking, scale),
    element('b', { class: 'bar-value', text: shortNumber(row.value) })))),
    axis(ranking, scale));
}

export function createRankings(report, store) {
  const figures = element('div', { class: 'rankings' });
  const caption = element('p', { class: 'muted' });
  store.watch(['group', 'run', 'hidden', 'theme', 'systemTheme'], (state) => {
    const rankings = rankingsOf(report, runsShown(report, state, groundOf(state)));
    figures.replaceChildren(...rankings.map((ranking) => figureOf(ranking, store)));
    const drives = Math.max(0, ...rankings.map((ranking) => ranking.drives));
    caption.textContent = drives > 1
      ? `Median over ${drives} drives; dots: each of them; line: from the smallest to the largest`
      : 'Line: where 90 of 100 scans lie';
  });
  store.watch(['highlight'], ({ highlight }) => {
    for (const row of figures.querySelectorAll('li')) row.classList.toggle('behind', highlight !== null && Number(row.dataset.run) !== highlight);
  });
  return element('section', { class: 'text-sheet' }, element('h2', { text: 'Ranking' }), figures, caption);
}
