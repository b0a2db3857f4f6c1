// The frames in a line: scrub, step, play, speed; frames that need attention are marked.
import { chooser, element, icon, iconButton } from '../dom.js';
import { lastFrame, troubledRanges } from '../runs.js';
import { SPEEDS } from '../player.js';
import { runAt } from '../session.js';

export function createTimeline(report, store, player) {
  const slider = element('input', {
    type: 'range', class: 'frames', min: 0, step: 1, 'aria-label': 'Frame', on: { input: () => player.goTo(Number(slider.value)) },
  });
  const marks = element('div', { class: 'frame-marks', 'aria-hidden': 'true' });
  const play = iconButton('play', 'Play or pause (space)', () => player.toggle(), { class: 'play' });
  const place = element('output', { class: 'frame-place' });
  const speed = chooser('Speed', SPEEDS.map((value) => ({ value: String(value), text: `${value}×` })),
    (value) => store.set({ speed: Number(value) }));
  const trouble = iconButton('flag', 'Next degenerate or lost frame (N)', () => goToTrouble(report, store, player, 1));

  store.watch(['run'], (state) => {
    const run = runAt(report, state);
    const last = lastFrame(run);
    slider.max = String(last);
    const ranges = troubledRanges(run);
    trouble.hidden = ranges.length === 0;
    marks.replaceChildren(...ranges.map(({ from, to, status }) => {
      const mark = element('i', { class: status });
      mark.style.left = `${(100 * from) / Math.max(1, last)}%`;
      mark.style.width = `${(100 * (to - from)) / Math.max(1, last)}%`;
      return mark;
    }));
  });
  store.watch(['run', 'frame'], (state) => {
    const run = runAt(report, state);
    slider.value = String(state.frame);
    slider.setAttribute('aria-valuetext', `frame ${state.frame} of ${lastFrame(run)}, ${run.frames.status[state.frame]}`);
    place.textContent = `${state.frame} / ${lastFrame(run)}`;
  });
  store.watch(['playing'], (state) => {
    play.replaceChildren(icon(state.playing ? 'pause' : 'play'));
    play.setAttribute('aria-pressed', String(state.playing));
  });
  store.watch(['speed'], (state) => speed.set(state.speed));
  return element('div', { class: 'timeline', role: 'group', 'aria-label': 'Timeline' },
    iconButton('first', 'First frame (Home)', () => player.goTo(0), { class: 'wide-only' }),
    iconButton('back', 'One frame back (←)', () => player.step(-1)), play,
    iconButton('forward', 'One frame on (→)', () => player.step(1)),
    element('div', { class: 'track' }, slider, marks), place, trouble, speed.element);
}

/** To the next (1) or last (-1) stretch of degenerate or lost frames; around the end. */
export function goToTrouble(report, store, player, direction) {
  const ranges = troubledRanges(runAt(report, store.state));
  if (ranges.length === 0) return;
  const { frame } = store.state;
  const starts = ranges.map(({ from }) => from);
  const next = direction > 0 ? starts.find((from) => from > frame) ?? starts[0]
    : starts.findLast((from) => from < frame) ?? starts.at(-1);
  player.goTo(next);
}
