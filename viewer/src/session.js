// What is looked at: the runs that are shown over each other, the one in front, and its frames.
import { CATEGORY_COUNT, categoryColour } from './colour/maps.js';
import { frameCount, keptScan, lastFrame } from './runs.js';

/** The groups of a page; a page of one run has one. */
export const groupsOf = (report) =>
  report.groups?.some(({ runs }) => runs.length) ? report.groups.filter(({ runs }) => runs.length) : [{ name: report.title, runs: report.runs.map((_, k) => k) }];

export const groupAt = (report, state) => groupsOf(report)[state.group] ?? groupsOf(report)[0];

export const runAt = (report, state) => report.runs[state.run];

/** The runs shown over each other, with their colours. */
export const runsShown = (report, state, ground) =>
  groupAt(report, state).runs
    .map((index, k) => {
      const place = report.runs[index].colour ?? k; // a method has one everywhere
      return { index, run: report.runs[index], colour: categoryColour(place, ground), dash: place >= CATEGORY_COUNT };
    })
    .filter(({ index }) => index === state.run || !state.hidden.has(index));

/** The frame of another run over the same recording that belongs to a frame of the one in front: the same scan. */
export function sameScan(from, frame, to) {
  if (from === to) return frame;
  const scan = from.frames.index[frame];
  let low = 0;
  let high = frameCount(to) - 1;
  while (low < high) {
    const middle = (low + high + 1) >> 1;
    if (to.frames.index[middle] <= scan) low = middle;
    else high = middle - 1;
  }
  return low;
}

/** What must be true of a state read from a link before it is used on this page. */
export function fitState(report, state) {
  const groups = groupsOf(report);
  const group = groups[state.group] ? state.group : 0;
  const runs = groups[group].runs;
  const withScans = runs.find((index) => report.runs[index].scans !== null);
  const run = runs.includes(state.run) ? state.run : withScans ?? runs[0] ?? 0;
  const object = report.runs[run].frames.objects.some((list) => list.some(([id]) => id === state.object)) ? state.object : null;
  return { ...state, group, run, frame: Math.min(state.frame, lastFrame(report.runs[run])), object, chase: object !== null && state.chase === true };
}

/** A frame to begin with: that of the scan the page names, which stands before all others in it. */
export function firstFrame(run) {
  if (run.scans) return run.scans.frames[run.scans.first] ?? 0;
  return Math.max(0, Math.min(frameCount(run) - 1, Math.floor(frameCount(run) / 4)));
}
