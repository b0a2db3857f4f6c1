// What the camera goes with: a place and the way it looks, about the origin that is drawn around.
import { Vector3 } from 'three';
import { poseOf } from '../runs.js';
import { headingInWorld, nearestOf, tracksOf, yawOf } from '../tracks.js';
import { poseMatrix } from './context.js';

/** @param {import('three').Matrix4} matrix of the sensor @param {number} heading rad, in the sensor frame */
export function sensorAnchor(matrix, heading) {
  const [x, y] = matrix.elements; // the sensor's x axis in the world
  return { place: matrix.elements.slice(12, 15), yaw: Math.atan2(y, x) + heading };
}

/** An object, or where it was last; null without one. @param {number|null} id */
export function objectAnchor(run, frame, id, origin) {
  const track = id === null ? null : tracksOf(run).get(id);
  if (!track) return null;
  const nearest = nearestOf(run, track, frame);
  const pose = poseOf(run.frames.poses, nearest.frame);
  if (!pose) return null;
  const centre = new Vector3(...nearest.centre).applyMatrix4(poseMatrix(pose, origin));
  const heading = headingInWorld(run, nearest.frame, nearest);
  return { place: centre.toArray(), yaw: heading === null ? yawOf(pose) + nearest.yaw : (heading * Math.PI) / 180 };
}
