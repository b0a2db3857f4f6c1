// Playing: as fast as the recording was, or slower or faster.
import { lastFrame, lastNotAbove } from './runs.js';
import { runAt } from './session.js';

export const SPEEDS = [0.1, 0.25, 0.5, 1, 2, 4, 8];

export function createPlayer(report, store) {
  let started = null; // wall clock (ms) and recording time (s) of the last start or jump
  let ticking = false;

  function tick(now) {
    const { playing, speed, frame } = store.state;
    ticking = playing;
    if (!playing) {
      started = null;
      return;
    }
    const { seconds } = runAt(report, store.state).frames;
    if (!started || started.frame !== frame || started.speed !== speed) {
      started = { now, at: seconds[frame], frame, speed };
    }
    const next = Math.max(frame, lastNotAbove(seconds, started.at + ((now - started.now) / 1000) * speed));
    if (next !== frame) {
      started.frame = next;
      store.set({ frame: next });
    }
    if (next >= seconds.length - 1) store.set({ playing: false });
    requestAnimationFrame(tick);
  }

  const last = () => lastFrame(runAt(report, store.state));
  return {
    toggle() {
      const { playing, frame } = store.state;
      if (playing) {
        store.set({ playing: false });
        return;
      }
      store.set({ playing: true, frame: frame >= last() ? 0 : frame });
      if (!ticking) requestAnimationFrame(tick);
    },
    /** @param {number} frame held within the run */
    goTo(frame) { store.set({ frame: Math.min(last(), Math.max(0, Math.round(frame))) }); },
    step(frames) {
      store.set({ playing: false });
      this.goTo(store.state.frame + frames);
    },
    faster(steps) {
      const at = Math.max(0, lastNotAbove(SPEEDS, store.state.speed));
      store.set({ speed: SPEEDS[Math.min(SPEEDS.length - 1, Math.max(0, at + steps))] });
    },
    last,
  };
}
