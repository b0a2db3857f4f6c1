// The numbers one asks for first: on top, of the run in front.
import { element } from '../dom.js';
import { runAt } from '../session.js';

const FACTS = ['method', 'preset', 'ablation'];
const HEADLINE = [
  ['frames', 'scans'], ['path_length_m', 'path'], ['rte_rmse_m', 'RTE'], ['rre_rmse_deg', 'RRE'],
  ['ate_rmse_m', 'ATE'], ['ms_mean', 'per scan'],
];
const STATUSES = ['ok', 'degenerate', 'lost'];

/** How many frames have which status; the first one, which is compared with nothing, is ok as in summary.json. */
export function statusCounts(statuses) {
  const counts = new Map(STATUSES.map((status) => [status, 0]));
  for (const status of statuses) {
    const counted = status === 'first' ? 'ok' : status;
    counts.set(counted, (counts.get(counted) ?? 0) + 1);
  }
  return counts;
}

export function createHeadline(report, store) {
  const line = element('dl', { class: 'headline' });
  store.watch(['run'], (state) => {
    const run = runAt(report, state);
    const facts = run.facts.filter(([name, value]) => FACTS.includes(name) && value !== 'none')
      .map(([name, value]) => element('div', {}, element('dt', { text: name }), element('dd', { text: value })));
    const numbers = HEADLINE.flatMap(([key, name]) => {
      const entry = run.summary.find((row) => row.key === key && row.value !== '-');
      return entry ? [element('div', { title: entry.meaning || key }, element('dt', { text: name }), element('dd', { text: entry.value }))] : [];
    });
    const counts = [...statusCounts(run.frames.status)].filter(([status, count]) => count > 0 || STATUSES.includes(status));
    const total = run.frames.status.length;
    line.replaceChildren(...facts, ...numbers, element('div', { title: `Status of ${total} scans` },
      element('dt', { text: 'status' }), element('dd', {}, ...counts.map(([status, count]) =>
        element('span', { class: `count ${count > 0 && STATUSES.includes(status) ? status : ''}`, text: `${count} ${status}` })))));
  });
  return line;
}
