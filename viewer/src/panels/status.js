// Over the view: which frame this is, how fast it goes, and what is wrong with it.
import { element, put } from '../dom.js';
import { counted, grouped, shortNumber } from '../format.js';
import { speedOf } from '../runs.js';
import { runAt } from '../session.js';

function scanNote(run, shown) {
  if (shown.trouble) return shown.trouble;
  if (run.scans === null) return 'No scans in this page: trajectory and objects only.';
  if (shown.place === null) return 'No scan of this frame in this page.';
  const parts = [];
  if (shown.scanFrame !== shown.frame) parts.push(`points of frame ${shown.scanFrame} (not every scan is in this page)`);
  if (!run.scans.whole[shown.place]) {
    parts.push(`${grouped(run.scans.points[shown.place])} of ${grouped(run.scans.of[shown.place])} points`);
  }
  return parts.join(' · ');
}

export function createStatus(report, store) {
  const badge = element('span');
  const line = element('div', { class: 'status-line' }, badge);
  const entries = [];
  const trouble = element('div', { class: 'status-trouble' });
  const note = element('div', { class: 'status-note' });
  store.watch(['frame', 'run', 'shown'], (state) => {
    const run = runAt(report, state);
    const { frame } = state;
    const { frames } = run;
    const status = frames.status[frame] ?? '';
    const facts = [
      ['frame', String(frame)],
      frames.index[frame] === frame ? null : ['scan', String(frames.index[frame])],
      ['time', `${frames.seconds[frame]?.toFixed(2)} s`],
      ['speed', `${shortNumber(speedOf(run, frame))} m/s`],
      ['moving', counted(frames.objects[frame]?.length ?? 0, 'object')],
    ].filter(Boolean);
    facts.forEach(([name, value], k) => {
      entries[k] ??= line.insertBefore(element('span', {}, element('small'), element('b')), badge);
      put(entries[k].firstChild, 'textContent', name);
      put(entries[k].lastChild, 'textContent', value);
    });
    while (entries.length > facts.length) entries.pop().remove();
    const look = `badge ${['ok', 'degenerate', 'lost', 'first'].includes(status) ? status : 'other'}`;
    put(badge, 'className', look);
    put(badge, 'textContent', status);
    const directions = frames.lost_directions[frame] ?? [];
    const reasons = [frames.reason[frame], directions.length ? `unknown: ${directions.join(', ')}` : ''].filter(Boolean);
    put(trouble, 'textContent', reasons.join(' · '));
    put(trouble, 'hidden', reasons.length === 0);
    put(note, 'textContent', state.shown ? scanNote(run, state.shown) : '');
    put(note, 'hidden', note.textContent === '');
  });
  return element('div', { class: 'status' }, line, trouble, note);
}
