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

/** The way the sensor looks while it drives, as an angle (rad) about its z axis: the mean direction of its velocity. */
export function headingInSensor(run) {
  let x = 0;
  let y = 0;
  for (let frame = 0; frame < frameCount(run); ++frame) {
    x += run.frames.ego_velocity[3 * frame] ?? 0;
    y += run.frames.ego_velocity[3 * frame + 1] ?? 0;
  }
  // A sensor that stands, or drives as much back as forth, has no such way.
  return Math.hypot(x, y) > 0.5 * frameCount(run) ? Math.atan2(y, x) : 0;
}

/** An object row of the page by names. */
export const objectOf = ([id, vx, vy, vz, cx, cy, cz, ex, ey, ez, yaw, points]) =>
  ({ id, velocity: [vx, vy, vz], centre: [cx, cy, cz], extent: [ex, ey, ez], yaw: (yaw * Math.PI) / 180, points });
