// The moving objects of a run as tracks: an id through all the frames where it is.
import { quantile } from './colour/colourings.js';
import { closest, objectOf, poseOf } from './runs.js';

const known = new WeakMap();
const MOVING = 0.3; // m/s; below, a velocity has no direction worth telling

/** Which faces of a box were seen, in the order of the page. */
const FACES = ['front', 'rear', 'left', 'right', 'top', 'bottom'];
const VIEWS = { s: 'seen', h: 'hidden', u: 'unknown' };

/**
 * @typedef {object} TrackDetails what the run states of an object beyond its box; `null` where it states nothing
 * @property {number} age scans
 * @property {boolean} observed whether the speed across the line of sight was measured
 * @property {{face: string, view: string}[]} faces
 * @property {number|null} speedSigma m/s @property {number|null} headingSigma degrees
 * @property {number|null} radialSigma m/s @property {number|null} tangentialSigma m/s @property {number|null} centreSigma m
 */

/** @returns {TrackDetails|null} of object `place` of the list of a frame */
export function detailsOf(run, frame, place) {
  const row = run.frames.object_details?.[frame]?.[place];
  if (!row) return null;
  const [age, observed, faces, speedSigma, headingSigma, radialSigma, tangentialSigma, centreSigma] = row;
  return {
    age, observed, speedSigma, headingSigma, radialSigma, tangentialSigma, centreSigma,
    faces: FACES.map((face, k) => ({ face, view: VIEWS[faces[k]] ?? 'unknown' })),
  };
}

/** The angle of a pose about the z axis of the world, rad: that of the sensor's x axis. */
export function yawOf([, , , x, y, z, w]) {
  return Math.atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z));
}

const degrees = (angle) => (((angle * 180) / Math.PI) % 360 + 360) % 360;

/** Where an object goes, in degrees from the x axis of the world, counterclockwise; null where nobody knows. */
export function headingInWorld(run, frame, { velocity: [vx, vy] }) {
  const pose = poseOf(run.frames.poses, frame);
  return pose && Math.hypot(vx, vy) > MOVING ? degrees(yawOf(pose) + Math.atan2(vy, vx)) : null;
}

/** An object at a frame: its row, what is stated of it, its speed. */
export function objectAt(run, frame, place) {
  const object = objectOf(run.frames.objects[frame][place]);
  return { ...object, frame, place, speed: Math.hypot(...object.velocity), details: detailsOf(run, frame, place) };
}

/**
 * @typedef {object} Track
 * @property {number} id
 * @property {number[]} frames ascending
 * @property {number[]} places of the object in the list of each of those frames
 * @returns {Map<number, Track>} by id, in the order of their first frames
 */
export function tracksOf(run) {
  if (known.has(run)) return known.get(run);
  const tracks = new Map();
  run.frames.objects.forEach((list, frame) => list.forEach(([id], place) => {
    if (!tracks.has(id)) tracks.set(id, { id, frames: [], places: [] });
    tracks.get(id).frames.push(frame);
    tracks.get(id).places.push(place);
  }));
  known.set(run, tracks);
  return tracks;
}

/** The object of a track at a frame or, where it is not there, at the nearest one where it is. */
export function nearestOf(run, track, frame) {
  const k = closest(track.frames, frame);
  return objectAt(run, track.frames[k], track.places[k]);
}

/** A track in a line: over all of its frames. */
export function summaryOf(run, track) {
  const all = track.frames.map((frame, k) => objectAt(run, frame, track.places[k]));
  const details = all.map((object) => object.details).filter(Boolean);
  const median = (values) => quantile(values, 0.5, null);
  const middle = all[all.length >> 1];
  return {
    id: track.id, scans: all.length, from: track.frames[0], to: track.frames.at(-1),
    speed: median(all.map(({ speed }) => speed)),
    speedSigma: median(details.map(({ speedSigma }) => speedSigma)),
    heading: headingInWorld(run, middle.frame, middle),
    extent: all.at(-1).extent,
    range: Math.min(...all.map(({ centre }) => Math.hypot(...centre))),
    observed: details.length ? details.filter(({ observed }) => observed).length / details.length : null,
    facesSeen: details.length ? details.at(-1).faces.filter(({ view }) => view === 'seen').length : null,
  };
}

/** The plot of a track's speed: from its first frame to its last, gaps where it is not there. */
export function speedPlotOf(run, track) {
  const { seconds } = run.frames;
  const [first, last] = [track.frames[0], track.frames.at(-1)];
  const length = last - first + 1;
  const ys = Array(length).fill(null);
  const sigma = Array(length).fill(null);
  track.frames.forEach((frame, k) => {
    const { speed, details } = objectAt(run, frame, track.places[k]);
    ys[frame - first] = speed;
    sigma[frame - first] = details?.speedSigma ?? null;
  });
  const margin = 0.02 * (seconds[last] - seconds[first]) || 0.5;
  return {
    id: 'track-speed', title: `Speed of object ${track.id}`, unit: 'm/s', xName: 'time (s)', y: { fromZero: true },
    x: { low: seconds[first] - margin, high: seconds[last] + margin },
    series: [{ name: sigma.some((value) => value !== null) ? 'speed, ± 1 sigma' : 'speed', colour: '--series-0', xs: seconds.slice(first, last + 1), ys, sigma }],
  };
}
