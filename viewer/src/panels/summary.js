// The sheets of one run: its numbers, warnings and command; its configuration.
import { button, element, pairTable } from '../dom.js';
import { runAt } from '../session.js';
import { groundOf } from '../theme.js';
import { copyText } from './copy.js';

const section = (title, ...children) => element('section', {}, element('h2', { text: title }), ...children);
const list = (texts, className) => element('ul', { class: className }, ...texts.map((text) => element('li', { text })));

function command(text) {
  const copy = button('Copy', 'Copy the command', () => copyText(text, copy));
  return section('Command', element('div', { class: 'command' }, element('pre', { text }), copy));
}

/** What has several statistics stands in one row: name, first part of the keys, last part. */
const MEASURES = [
  ['RTE', 'rte_', '_m'], ['RRE', 'rre_', '_deg'], ['ATE, SE(3) aligned', 'ate_', '_m'], ['time per scan', 'ms_', ''],
];
const STATISTICS = [['rmse', 'RMSE'], ['mean', 'mean'], ['median', 'median'], ['p95', 'p95']];

/**
 * The summary as a table of measures by statistics, and what is in no such row.
 * @returns {{rows: {name: string, cells: (object|undefined)[]}[], rest: object[]}}
 */
export function byMeasure(summary) {
  const rest = new Map(summary.map((entry) => [entry.key, entry]));
  const rows = MEASURES.map(([name, first, last]) => ({
    name,
    cells: STATISTICS.map(([statistic]) => {
      const key = `${first}${statistic}${last}`;
      const entry = rest.get(key);
      rest.delete(key);
      return entry;
    }),
  })).filter(({ cells }) => cells.some(Boolean));
  return { rows, rest: [...rest.values()] };
}

function summaryTables(summary) {
  const { rows, rest } = byMeasure(summary);
  const used = STATISTICS.map((_, k) => k).filter((k) => rows.some(({ cells }) => cells[k]));
  return [
    rows.length ? element('div', { class: 'scroll' }, element('table', { class: 'measures' },
      element('thead', {}, element('tr', {}, element('th'), ...used.map((k) => element('th', { scope: 'col', text: STATISTICS[k][1] })))),
      element('tbody', {}, ...rows.map(({ name, cells }) => element('tr', {}, element('th', { scope: 'row', text: name }),
        ...used.map((k) => element('td', { text: cells[k]?.value ?? '', title: cells[k] ? cells[k].meaning || cells[k].key : null }))))))) : null,
    element('table', { class: 'summary' }, element('tbody', {}, ...rest.map(({ key, value, meaning }) => element('tr', {},
      element('th', { scope: 'row', title: key, text: meaning || key }), element('td', { text: value }))))),
  ].filter(Boolean);
}

const picture = ({ title, caption, svg, svg_dark: dark }, ground) => section(title, element('figure', {},
  element('img', { src: `data:image/svg+xml;charset=utf-8,${encodeURIComponent(ground === 'dark' && dark ? dark : svg)}`, alt: title }),
  element('figcaption', { class: 'muted', text: caption })));

export function createSummarySheet(report, store) {
  const sheet = element('div', { class: 'text-sheet' });
  store.watch(['run', 'theme', 'systemTheme'], (state) => {
    const run = runAt(report, state);
    sheet.replaceChildren(...[
      report.kind === 'run' ? null : element('h2', { class: 'run-name', text: run.name }),
      run.warnings.length ? section('Warnings', list(run.warnings, 'warnings')) : null,
      report.notes.length ? section('Notes', list(report.notes, 'notes')) : null,
      section('Summary', ...summaryTables(run.summary)),
      ...run.pictures.map((entry) => picture(entry, groundOf(state))),
      section('Run', pairTable([['recording', run.name], ...run.facts])),
      run.command ? command(run.command) : null,
      element('p', { class: 'muted', text: `Page made by ${report.generator}` }),
    ].filter(Boolean));
  });
  return sheet;
}

/** Entries by the first part of their key ("registration.kernel" -> "registration"), in the order given. */
export function byStage(entries) {
  const stages = new Map();
  for (const [key, value] of entries) {
    const [stage] = key.split('.');
    if (!stages.has(stage)) stages.set(stage, []);
    stages.get(stage).push([key, value]);
  }
  return stages;
}

export function createConfigurationSheet(report, store) {
  const search = element('input', { type: 'search', placeholder: 'Search settings', 'aria-label': 'Search settings' });
  const found = element('div');
  const origin = element('div');
  const fill = () => {
    const run = runAt(report, store.state);
    const wanted = search.value.trim().toLowerCase();
    const entries = run.configuration.filter(([key, value]) => `${key} ${value}`.toLowerCase().includes(wanted));
    origin.replaceChildren(...(run.origin.length ? [section('Provenance', pairTable(run.origin))] : []));
    found.replaceChildren(...(entries.length
      ? [...byStage(entries)].map(([stage, rows]) => element('details', { open: wanted !== '' },
        element('summary', { text: `${stage} (${rows.length})` }), pairTable(rows)))
      : [element('p', { class: 'muted', text: wanted ? 'No setting says this.' : 'The run holds no configuration.' })]));
  };
  search.addEventListener('input', fill);
  store.watch(['run'], fill);
  return element('div', { class: 'text-sheet' }, origin, section('Configuration', search, found));
}
