// Runs side by side: which are shown, and their numbers with the best marked.
import { element } from '../dom.js';
import { toggled } from '../layers.js';
import { groupAt, runsShown } from '../session.js';
import { groundOf } from '../theme.js';

/** The chips of the runs of a group: a click brings a run to the front, the box shows or hides it. */
export function createRunChips(report, store) {
  const chips = element('div', { class: 'chips', role: 'group', 'aria-label': 'Runs shown' });
  store.watch(['group', 'run', 'hidden', 'theme', 'systemTheme'], (state) => {
    const all = runsShown(report, { ...state, hidden: new Set() }, groundOf(state));
    chips.replaceChildren(...all.map(({ index, run, colour, dash }) => {
      const swatch = element('i', { class: dash ? 'swatch dash' : 'swatch' });
      swatch.style.setProperty('--swatch', colour);
      const front = index === state.run;
      return element('span', { class: front ? 'chip front' : 'chip' },
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

const cell = (text, best, second = false) => element('td', { class: best ? 'best' : second ? 'second' : null }, best ? element('span', { class: 'star', title: 'best', text: '★' }) : null, text);

export function createComparisonSheet(report, store) {
  const sheet = element('div', { class: 'text-sheet' });
  store.watch(['group'], (state) => {
    const group = groupAt(report, state);
    const runs = group.runs.map((index) => report.runs[index]);
    const rows = new Map();
    for (const run of runs) for (const entry of run.summary) if (!rows.has(entry.key)) rows.set(entry.key, entry);
    sheet.replaceChildren(
      element('h2', { text: group.name }),
      element('div', { class: 'scroll' }, element('table', { class: 'numbers' },
        element('thead', {}, element('tr', {}, element('th', { text: '' }),
          ...runs.map((run) => element('th', { scope: 'col', text: run.name })))),
        element('tbody', {}, ...[...rows.values()].map(({ key, meaning, better }) => {
          const entries = runs.map((run) => run.summary.find((entry) => entry.key === key));
          const best = bestOf(entries.map((entry) => entry?.number ?? null), better);
          return element('tr', {},
            element('th', { scope: 'row', title: key, text: meaning || key }),
            ...entries.map((entry, k) => cell(entry?.value ?? '–', best[k])));
        })))),
      element('p', { class: 'muted', text: '★ best of the runs that have this number' }));
  });
  return sheet;
}

/** The tables of a benchmark. */
export function createTableSheet(report) {
  return element('div', { class: 'text-sheet' }, ...report.tables.map(({ title, caption, columns, rows, best, second }) =>
    element('section', {}, element('h2', { text: title }),
      element('div', { class: 'scroll' }, element('table', { class: 'numbers' },
        element('thead', {}, element('tr', {}, ...columns.map((text) => element('th', { scope: 'col', text })))),
        element('tbody', {}, ...rows.map((row, r) => element('tr', {}, ...row.map((text, c) =>
          (c === 0 ? element('th', { scope: 'row', text }) : cell(text, best?.[r]?.[c] ?? false, second?.[r]?.[c] ?? false)))))))),
      caption ? element('p', { class: 'muted', text: caption }) : null)));
}
