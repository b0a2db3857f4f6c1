// The sheets of one run: its numbers, warnings and command; its configuration.
import { button, element, pairTable } from '../dom.js';
import { runAt } from '../session.js';
import { copyText } from './copy.js';

const section = (title, ...children) => element('section', {}, element('h2', { text: title }), ...children);
const list = (texts, className) => element('ul', { class: className }, ...texts.map((text) => element('li', { text })));

function command(text) {
  const copy = button('Copy', 'Copy the command', () => copyText(text, copy));
  return section('Command', element('div', { class: 'command' }, element('pre', { text }), copy));
}

const summaryTable = (summary) => element('table', { class: 'summary' }, element('tbody', {},
  ...summary.map(({ key, value, meaning }) => element('tr', {},
    element('th', { scope: 'row' }, element('span', { text: meaning || key }), meaning ? element('code', { text: key }) : null),
    element('td', { text: value })))));

const picture = ({ title, caption, svg }) => section(title, element('figure', {},
  element('img', { src: `data:image/svg+xml;charset=utf-8,${encodeURIComponent(svg)}`, alt: title }),
  element('figcaption', { class: 'muted', text: caption })));

export function createSummarySheet(report, store) {
  const sheet = element('div', { class: 'text-sheet' });
  store.watch(['run'], (state) => {
    const run = runAt(report, state);
    sheet.replaceChildren(...[
      report.kind === 'run' ? null : element('h2', { class: 'run-name', text: run.name }),
      run.warnings.length ? section('Warnings', list(run.warnings, 'warnings')) : null,
      section('Summary', summaryTable(run.summary)),
      ...run.pictures.map(picture),
      section('Run', pairTable([['recording', run.name], ...run.facts])),
      report.notes.length ? section('Notes', list(report.notes, 'notes')) : null,
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
