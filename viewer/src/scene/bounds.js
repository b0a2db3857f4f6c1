// How far the ways of runs reach.
import { frameCount } from '../runs.js';

/** The middle and half the diagonal of all positions of the runs, m, about the origin. */
export function boundsOf(runs, origin) {
  const low = [Infinity, Infinity, Infinity];
  const high = [-Infinity, -Infinity, -Infinity];
  for (const run of runs) {
    const { poses } = run.frames;
    for (let frame = 0; frame < frameCount(run); ++frame) {
      if (!Number.isFinite(poses[7 * frame])) continue;
      for (let axis = 0; axis < 3; ++axis) {
        const value = poses[7 * frame + axis] - origin[axis];
        low[axis] = Math.min(low[axis], value);
        high[axis] = Math.max(high[axis], value);
      }
    }
  }
  if (!Number.isFinite(low[0])) return { centre: [0, 0, 0], radius: 30 };
  return {
    centre: low.map((value, axis) => 0.5 * (value + high[axis])),
    radius: Math.max(10, 0.5 * Math.hypot(...low.map((value, axis) => high[axis] - value))),
  };
}
