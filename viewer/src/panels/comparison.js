// Runs side by side: which are shown, and their numbers with the best marked.
import { element } from '../dom.js';
import { withUnit, counted } from '../format.js';
import { toggled } from '../layers.js';
import { groupAt, runsShown } from '../session.js';
import { groundOf } from '../theme.js';
import { sortableTable } from './sortable.js';

/** The chips of the runs of a group: a click brings a run to the front, the box shows or hides it. */
export function createRunChips(report, store) {
  const chips = element('div', { class: 'chips', role: 'group', 'aria-label': 'Runs shown' });
  store.watch(['group', 'run', 'hidden', 'theme', 'systemTheme'], (state) => {
    const all = runsShown(report, { ...state, hidden: new Set() }, groundOf(state));
    chips.replaceChildren(...all.map(({ index, run, colour, dash }) => {
      const swatch = element('i', { class: dash ? 'swatch dash' : 'swatch' });
      swatch.style.setProperty('--swatch', colour);
      const front = index === state.run;
      const highlight = (index_) => () => store.set({ highlight: index_ });
      return element('span', {
        class: front ? 'chip front' : 'chip',
        on: { pointerenter: highlight(index), pointerleave: highlight(null), focusin: highlight(index), focusout: highlight(null) },
      },
        element('input', {
          type: 'checkbox', checked: front || !state.hidden.has(index), disabled: front, 'aria-label': `Show ${run.name}`,
          on: { change: () => store.set({ hidden: toggled(store.state.hidden, index) }) },
        }),
        element('button', {
          type: 'button', 'aria-pressed': String(front), title: 'Bring this run to the front: its scans, objects and status',
          on: { click: () => store.set({ run: index, limit: null }) },
        }, swatch, element('span', { text: run.name })));
    }));
  });
  return chips;
}

/**
 * Which of the runs win a number: none where one has no value or all are equal.
 * @param {(number|null)[]} numbers @param {'lower'|'higher'|null|undefined} better
 */
export function bestOf(numbers, better) {
  const known = numbers.filter((value) => value !== null && value !== undefined && Number.isFinite(value));
  if (!better || known.length < 2) return numbers.map(() => false);
  const best = better === 'lower' ? Math.min(...known) : Math.max(...known);
  if (known.every((value) => value === best)) return numbers.map(() => false);
  return numbers.map((value) => value === best);
}

/** What reads the same is as good: digits that are not shown decide nothing, and where all read the same nobody wins. */
function alike(marked, texts) {
  const all = texts.map((text) => texts.some((other, k) => marked[k] && other === text));
  return all.every(Boolean) ? all.map(() => false) : all;
}

/** Which of the runs come after the best, where there are more than two. */
function secondOf(numbers, best, better) {
  const rest = numbers.map((value, k) => (best[k] ? null : value));
  return best.some(Boolean) && numbers.length > 2 ? bestOf(rest, better) : numbers.map(() => false);
}

const cell = (text, best, second = false) => element('td', { class: best ? 'best' : second ? 'second' : null }, best ? element('span', { class: 'star', title: 'best', text: '★' }) : null, text);

/** How far two runs over one recording are apart that read it from different containers. */
function apartText(report, { runs, scans, translation_mm: translation, rotation_deg: rotation }) {
  const names = runs.map((index) => report.runs[index].name).join(' and ');
  return translation === 0 && rotation === 0
    ? `${names}: one recording from two containers, the same trajectory in all ${counted(scans, 'scan')}`
    : `${names}: one recording from two containers, at most ${withUnit(translation, 'mm')} and ${withUnit(rotation, '°')} apart in ${counted(scans, 'scan')}`;
}

export function createComparisonSheet(report, store) {
  const sheet = element('div', { class: 'text-sheet' });
  store.watch(['group'], (state) => {
    const group = groupAt(report, state);
    const runs = group.runs.map((index) => report.runs[index]);
    const rows = new Map();
    for (const run of runs) for (const entry of run.summary) if (!rows.has(entry.key)) rows.set(entry.key, entry);
    // A run a row: what is compared stands below each other and can be sorted. First what has a better and a worse.
    const measures = [...rows.values()].sort((a, b) => Number(!a.better) - Number(!b.better));
    const cells = new Map(measures.map(({ key, better }) => {
      const entries = runs.map((run) => run.summary.find((entry) => entry.key === key));
      const numbers = entries.map((entry) => entry?.number ?? null);
      const texts = entries.map((entry) => entry?.value);
      const best = alike(bestOf(numbers, better), texts);
      const second = alike(secondOf(numbers, best, better), texts);
      return [key, { entries, best, second }];
    }));
    const table = runs.map((run, k) => {
      const texts = measures.map(({ key }) => cells.get(key).entries[k]?.value ?? '–');
      return {
        texts: [run.name, ...texts],
        row: element('tr', {}, element('th', { scope: 'row', text: run.name }),
          ...measures.map(({ key }, m) => cell(texts[m], cells.get(key).best[k], cells.get(key).second[k]))),
      };
    });
    sheet.replaceChildren(
      element('h2', { text: group.name }),
      element('div', { class: 'scroll' }, sortableTable(['run', ...measures.map(({ key, meaning }) => (meaning || key).split(';')[0])], table, { class: 'numbers' })),
      element('p', { class: 'muted', text: '★ best, underlined second of the runs that have this number' }),
      ...(group.differences ?? []).map((difference) => element('p', { class: 'apart', text: apartText(report, difference) })));
  });
  return sheet;
}

/** The tables of a benchmark. */
export function createTableSheet(report) {
  return element('div', { class: 'text-sheet' }, ...report.tables.map(({ title, caption, columns, rows, best, second }) =>
    element('section', {}, element('h2', { text: title }),
      element('div', { class: 'scroll' }, sortableTable(columns, rows.map((row, r) => ({
        texts: row,
        row: element('tr', {}, ...row.map((text, c) =>
          (c === 0 ? element('th', { scope: 'row', text }) : cell(text, best?.[r]?.[c] ?? false, second?.[r]?.[c] ?? false)))),
      })), { class: 'numbers' })),
      caption ? element('p', { class: 'muted', text: caption }) : null)));
}
