// The ways of the runs and of the ground truth: what is driven is strong, what is to come is pale.
import { Group } from 'three';
import { rgb } from '../colour/maps.js';
import { frameCount } from '../runs.js';
import { createSegments } from './segments.js';

/**
 * Lines from pose to pose; where a pose is missing there is a gap.
 * @returns {{ends: number[], until: number[]}} `until`: the frame each line ends at
 */
export function pathSegments(poses, count, origin) {
  const ends = [];
  const until = [];
  const isKnown = (frame) => {
    for (let k = 7 * frame; k < 7 * frame + 7; ++k) if (!Number.isFinite(poses[k])) return false;
    return true;
  };
  let wasKnown = false;
  for (let frame = 0; frame < count; ++frame) {
    const known = isKnown(frame);
    if (known && wasKnown) {
      for (const place of [frame - 1, frame]) for (let axis = 0; axis < 3; ++axis) ends.push(poses[7 * place + axis] - origin[axis]);
      until.push(frame);
    }
    wasKnown = known;
  }
  return { ends, until };
}

function createPath(poses, count, origin, colour, look) {
  const { ends, until } = pathSegments(poses, count, origin);
  const lines = createSegments(look);
  const shares = rgb(colour).map((value) => value / 255);
  lines.show(ends, until.flatMap(() => shares), until);
  return { object: lines.object, drive: lines.setNow, fade: lines.fade, dispose: lines.dispose };
}

export function createPaths() {
  const estimates = new Group();
  const truths = new Group();
  let paths = [];
  return {
    estimates,
    truths,
    /** @param {{run: object, colour: string}[]} shown @param {object|null} reference whose truth is drawn */
    show(shown, reference, truthColour, origin) {
      for (const path of paths) path.dispose();
      estimates.clear();
      truths.clear();
      paths = shown.map(({ run, colour }) => {
        const path = createPath(run.frames.poses, frameCount(run), origin, colour, { width: 2.4, opacity: 1, pale: 0.4 });
        estimates.add(path.object);
        return { ...path, run };
      });
      if (reference) {
        const path = createPath(reference.truth.poses, frameCount(reference), origin, truthColour,
          { width: 6, opacity: 0.35, pale: 0.18 });
        truths.add(path.object);
        paths.push({ ...path, run: reference, isTruth: true });
      }
    },
    /** Only this run is drawn strong; all of them for null. */
    highlight(run) { for (const path of paths) path.fade(run !== null && path.run !== run && !path.isTruth ? 0.12 : 1); },
    /** @param {(run: object) => number} frameOf the current frame of each run */
    drive(frameOf) { for (const path of paths) path.drive(frameOf(path.run)); },
  };
}
