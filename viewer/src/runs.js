// Reading a run: its frames, poses and kept scans.

export const frameCount = (run) => run.frames.index.length;

/** 0 also where there is none. */
export const lastFrame = (run) => Math.max(0, frameCount(run) - 1);

/** Pose `frame` of a flat list as [x y z qx qy qz qw], or null where there is none. */
export function poseOf(poses, frame) {
  const pose = poses.slice(7 * frame, 7 * frame + 7);
  return pose.length === 7 && pose.every((value) => value !== null && Number.isFinite(value)) ? pose : null;
}

/** Where the sensor was first: what is drawn is drawn around it, since graphics know only 7 digits. */
export function originOf(run) {
  for (let frame = 0; frame < frameCount(run); ++frame) {
    const pose = poseOf(run.frames.poses, frame);
    if (pose) return pose.slice(0, 3);
  }
  return [0, 0, 0];
}

/** m/s, or null */
export function speedOf(run, frame) {
  const velocity = run.frames.ego_velocity.slice(3 * frame, 3 * frame + 3);
  return velocity.length === 3 && velocity.every((value) => value !== null) ? Math.hypot(...velocity) : null;
}

/** The place of the last element of an ascending list that is not above `value`; -1 when all are. */
export function lastNotAbove(list, value) {
  let low = 0;
  let high = list.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (list[middle] <= value) low = middle + 1;
    else high = middle;
  }
  return low - 1;
}

/** The place of the element of an ascending list that is closest to `value`. */
export function closest(list, value) {
  const below = Math.max(0, lastNotAbove(list, value));
  const above = Math.min(list.length - 1, below + 1);
  return value - list[below] <= list[above] - value ? below : above;
}

/** Which kept scan a frame shows: its own or the one before; null when there is none. */
export function keptScan(run, frame) {
  const place = run.scans ? lastNotAbove(run.scans.frames, frame) : -1;
  return place < 0 ? null : place;
}

/** Frames that need attention: ranges of equal status that is neither good nor the first. */
export function troubledRanges(run) {
  const ranges = [];
  run.frames.status.forEach((status, frame) => {
    if (status !== 'degenerate' && status !== 'lost') return;
    const last = ranges.at(-1);
    if (last && last.status === status && last.to === frame - 1) last.to = frame;
    else ranges.push({ status, from: frame, to: frame });
  });
  return ranges;
}

const DRIVING = 2; // m/s; a slower mean motion may be the error of a run that lost itself
const ALL_AROUND = 0.3; // mean of the unit directions, 0 to 1: below, no side has more points than another

/**
 * Where the points of a scan are, as an angle (rad) about the sensor's z axis; null where they are all around it.
 * Every point counts by its direction alone: a far wall to one side does not turn it.
 */
export function facingOf(positions) {
  let x = 0;
  let y = 0;
  let count = 0;
  for (let i = 0; i + 2 < positions.length; i += 3) {
    const range = Math.hypot(positions[i], positions[i + 1]);
    if (!(range > 0)) continue;
    x += positions[i] / range;
    y += positions[i + 1] / range;
    ++count;
  }
  return count > 0 && Math.hypot(x, y) > ALL_AROUND * count ? Math.atan2(y, x) : null;
}

/**
 * The way the sensor looks, as an angle (rad) about its z axis: the mean direction of its velocity while it drives into
 * what it sees, else where its points are, else ahead.
 * @param {number|null} facing of its points
 */
export function headingInSensor(run, facing) {
  let x = 0;
  let y = 0;
  for (let frame = 0; frame < frameCount(run); ++frame) {
    x += run.frames.ego_velocity[3 * frame] ?? 0;
    y += run.frames.ego_velocity[3 * frame + 1] ?? 0;
  }
  const drives = Math.hypot(x, y) > DRIVING * frameCount(run);
  const agrees = facing === null || x * Math.cos(facing) + y * Math.sin(facing) >= 0;
  return drives && agrees ? Math.atan2(y, x) : facing ?? 0;
}

/** An object row of the page by names. */
export const objectOf = ([id, vx, vy, vz, cx, cy, cz, ex, ey, ez, yaw, points]) =>
  ({ id, velocity: [vx, vy, vz], centre: [cx, cy, cz], extent: [ex, ey, ez], yaw: (yaw * Math.PI) / 180, points });
