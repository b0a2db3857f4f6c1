// What the points of a scan can be coloured by.
import { lastNotAbove, speedOf } from '../runs.js';

/**
 * `source` is the number the shader knows the value by. `limit`: the range is [-limit, limit] for two-sided maps and
 * [0, limit] for others; height has a range of its own.
 */
export const colourings = [
  { id: 'compensated', source: 0, key: '1', name: 'Doppler, ego-motion compensated', unit: 'm/s', map: 'diverging',
    meaning: 'Doppler velocity without the sensor’s own motion: the middle of the bar is static, left of it approaching, right of it receding' },
  { id: 'doppler', source: 1, key: '2', name: 'Doppler as measured', unit: 'm/s', map: 'diverging',
    meaning: 'Doppler velocity as measured: left of the middle of the bar approaching, right of it receding' },
  { id: 'kind', source: 2, key: '3', name: 'Segmentation', unit: '', map: 'categories',
    meaning: 'Class of a point: static, moving or object; every object has its colour' },
  { id: 'residual', source: 3, key: '4', name: 'Residual', unit: 'm', map: 'sequential',
    meaning: 'Distance to the surface of the previous scan' },
  { id: 'height', source: 4, key: '5', name: 'Height', unit: 'm', map: 'sequential',
    meaning: 'Height over the ground under the sensor' },
];

export const colouring = (id) => colourings.find((entry) => entry.id === id) ?? colourings[0];

const LIMITS = [0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 30, 50, 100];
export const COLOUR_LIMIT = { least: LIMITS[0], most: LIMITS.at(-1) };

/** The next rounder limit above (`steps` = 1) or below (-1). */
export function nextLimit(limit, steps) {
  const at = LIMITS.findIndex((entry) => entry >= limit * 0.999);
  const place = at < 0 ? LIMITS.length - 1 : at;
  return LIMITS[Math.min(LIMITS.length - 1, Math.max(0, place + steps))];
}

/** The value that `share` of the list stay below, or `otherwise`. */
export function quantile(values, share, otherwise) {
  const sorted = Array.from(values).filter((value) => value !== null && Number.isFinite(value)).sort((a, b) => a - b);
  return sorted.length ? sorted[Math.min(sorted.length - 1, Math.floor(share * sorted.length))] : otherwise;
}

const rounder = (limit, least) => Math.max(least, LIMITS[Math.min(LIMITS.length - 1, lastNotAbove(LIMITS, limit * 0.999) + 1)]);

const SHARE_SHOWN = 0.98; // of the values; a few wrong ones must not make all others look alike
const FASTEST = 70; // m/s, of anything on a road

/** Of an object row: speed (m/s), and what of it a Doppler would show. */
const speedsOf = ([, vx, vy, vz, cx, cy, cz]) =>
  ({ whole: Math.hypot(vx, vy, vz), radial: Math.abs(vx * cx + vy * cy + vz * cz) / Math.hypot(cx, cy, cz) });

/** Limits that suit a run: by its own speed and by those of its objects. `arrow`: m, of arrows as long as the displacement in 1 s. */
export function usualLimits(run) {
  const speeds = run.frames.index.map((_, frame) => speedOf(run, frame));
  const objects = run.frames.objects.flat().map(speedsOf);
  const shown = (values, otherwise) => Math.min(FASTEST, quantile(values, SHARE_SHOWN, otherwise));
  return {
    compensated: rounder(shown(objects.map(({ radial }) => radial), 5), 2),
    doppler: rounder(shown(speeds, 5), 2),
    kind: 1,
    residual: 0.2,
    height: 10,
    arrow: Math.max(5, shown(objects.map(({ whole }) => whole), FASTEST)),
  };
}
