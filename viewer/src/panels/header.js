// The line on top: what this is, which runs are looked at, the look of the page, a link to this state.
import { button, chooser, element, iconButton } from '../dom.js';
import { groupAt, groupsOf, runAt } from '../session.js';
import { otherTheme } from '../theme.js';
import { copyText } from './copy.js';
import { createHeadline } from './headline.js';

export function createHeader(report, store, { showHelp, link }) {
  const groups = groupsOf(report);
  const several = report.kind !== 'run';
  const groupList = chooser('Sequence', groups.map(({ name }, k) => ({ value: String(k), text: name })),
    (value) => store.set({ group: Number(value), run: firstRun(report, Number(value)), hidden: new Set(), limit: null }));
  const runList = chooser('Run in front', [], (value) => store.set({ run: Number(value), limit: null }));
  const warnings = button('', 'Show the warnings', () => {
    store.set({ tab: 'summary' });
    document.getElementById('sheet-summary')?.scrollIntoView({ block: 'nearest' });
  }, { class: 'warning-count' });
  const theme = iconButton('theme', 'Light or dark (T)', () => store.set({ theme: otherTheme(store.state) }));
  const share = button('Copy link', 'Copy link to exactly this view', () => copyText(link(), share));
  const help = button('?', 'Keys and hints (?)', showHelp);

  store.watch(['group', 'run'], (state) => {
    const group = groupAt(report, state);
    const run = runAt(report, state);
    groupList.set(state.group);
    runList.offer(group.runs.map((index) => ({ value: String(index), text: report.runs[index].name })));
    runList.set(state.run);
    const count = run.warnings.length + report.notes.length;
    warnings.textContent = `⚠ ${count}`;
    warnings.setAttribute('aria-label', `⚠ ${count}: show the warnings`); // what is read begins with what is seen
    warnings.hidden = count === 0;
  });

  return element('header', { class: 'top' },
    element('h1', { text: report.title, title: report.title }),
    several && groups.length > 1 ? groupList.element : null,
    several ? runList.element : null,
    several ? null : createHeadline(report, store), // of several runs the table tells all
    element('div', { class: 'top-actions' }, warnings, share, theme, help));
}

/** The run a group begins with: the first that has scans, else the first. */
export function firstRun(report, group) {
  const { runs } = groupsOf(report)[group];
  return runs.find((index) => report.runs[index].scans !== null) ?? runs[0];
}
