// The frames that deserve a look, of all runs that are shown: in this page, and in the run's own page with its points.
import { element } from '../dom.js';
import { withUnit } from '../format.js';
import { lastNotAbove } from '../runs.js';
import { runsShown } from '../session.js';
import { groundOf } from '../theme.js';

const MOST_ROWS = 12;

/** The address of a frame in the page of its run: folders may have any names. */
export const linkTo = (page, frame) => `${page.split('/').map(encodeURIComponent).join('/')}#frame=${frame}`;

/** Largest errors first; what has none keeps its order behind them. */
export function worstOf(shown) {
  return shown.flatMap((entry) => (entry.run.worst ?? []).map((frame) => ({ ...entry, ...frame })))
    .sort((a, b) => (b.translation_mm ?? -1) - (a.translation_mm ?? -1)).slice(0, MOST_ROWS);
}

function rowOf({ index, run, colour, dash, frame, scan, status, translation_mm: translation, rotation_deg: rotation }, store, hasPages) {
  const swatch = element('i', { class: dash ? 'swatch dash' : 'swatch' });
  swatch.style.setProperty('--swatch', colour);
  const here = () => store.set({ run: index, frame: Math.max(0, lastNotAbove(run.frames.index, scan)) });
  return element('tr', {},
    element('th', { scope: 'row' }, swatch, ` ${run.name}`),
    element('td', {}, element('button', { type: 'button', text: String(scan), title: 'Show this scan in the view below', 'aria-label': `Scan ${scan} of ${run.name} in the view`, on: { click: here } })),
    hasPages ? element('td', {}, run.page ? element('a', { href: linkTo(run.page, frame), text: 'open', 'aria-label': `Open scan ${scan} in the page of ${run.name}` }) : null) : null,
    element('td', { text: withUnit(translation, 'mm') }), element('td', { text: withUnit(rotation, '°') }),
    element('td', {}, element('span', { class: `badge ${status}`, text: status })));
}

export function createWorstFrames(report, store) {
  const section = element('section', { class: 'text-sheet worst' });
  store.watch(['group', 'run', 'hidden', 'theme', 'systemTheme'], (state) => {
    const worst = worstOf(runsShown(report, state, groundOf(state)));
    section.hidden = worst.length === 0;
    const hasPages = worst.some(({ run }) => run.page);
    section.replaceChildren(element('h2', { text: 'Worst scans' }),
      element('div', { class: 'scroll' }, element('table', { class: 'numbers' },
        element('thead', {}, element('tr', {}, ...['run', 'scan', ...(hasPages ? ['page'] : []), 'RTE', 'RRE', 'status'].map((text) => element('th', { scope: 'col', text })))),
        element('tbody', {}, ...worst.map((frame) => rowOf(frame, store, hasPages))))),
      element('p', { class: 'muted', text: hasPages
        ? 'At most five of each run. "open" shows the scan with its points in the page of the run.'
        : 'At most five of each run. Runs that have a report.html of their own would be linked here.' }));
  });
  return section;
}
