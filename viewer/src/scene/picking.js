// Which point of a scan, and which box, is under the pointer.

/**
 * @param {Float32Array} positions
 * @param {ArrayLike<number>} matrix scan to clip space, 16 numbers, column by column
 * @param {{x: number, y: number, width: number, height: number, reach: number}} pointer all in pixels
 * @param {(i: number) => boolean} isShown
 * @returns {number} place of the point nearest to the eye within reach, or -1
 */
export function pointUnder(positions, count, matrix, { x, y, width, height, reach }, isShown = () => true) {
  let found = -1;
  let least = Infinity;
  for (let i = 0; i < count; ++i) {
    const [px, py, pz] = [positions[3 * i], positions[3 * i + 1], positions[3 * i + 2]];
    const w = matrix[3] * px + matrix[7] * py + matrix[11] * pz + matrix[15];
    if (w <= 0) continue;
    const sx = (0.5 + (0.5 * (matrix[0] * px + matrix[4] * py + matrix[8] * pz + matrix[12])) / w) * width;
    const sy = (0.5 - (0.5 * (matrix[1] * px + matrix[5] * py + matrix[9] * pz + matrix[13])) / w) * height;
    const away = Math.hypot(sx - x, sy - y);
    // A pixel off counts as much as 2 % more distance: the near one of points that are equally well hit.
    const cost = w * (1 + 0.02 * away * away);
    if (away <= reach && cost < least && isShown(i)) {
      least = cost;
      found = i;
    }
  }
  return found;
}

/** A place in clip space through a matrix (column by column), as a point. */
function throughMatrix(matrix, [x, y, z]) {
  const row = (k) => matrix[k] * x + matrix[k + 4] * y + matrix[k + 8] * z + matrix[k + 12];
  const w = row(3);
  return [row(0) / w, row(1) / w, row(2) / w];
}

/**
 * The line of sight through a pixel.
 * @param {ArrayLike<number>} fromClip clip space to the frame that is wanted, 16 numbers, column by column
 * @returns {{from: number[], along: number[]}} the direction has unit length
 */
export function rayThrough(fromClip, { x, y, width, height }) {
  const [cx, cy] = [(2 * x) / width - 1, 1 - (2 * y) / height];
  const from = throughMatrix(fromClip, [cx, cy, -1]);
  const to = throughMatrix(fromClip, [cx, cy, 1]);
  const way = to.map((value, k) => value - from[k]);
  const length = Math.hypot(...way);
  return { from, along: way.map((value) => value / length) };
}

/** How far along a ray it enters a box turned by yaw about z; null where it misses it. */
export function enters({ from, along }, { centre, extent, yaw }) {
  const [cos, sin] = [Math.cos(yaw), Math.sin(yaw)];
  const turned = ([x, y, z]) => [cos * x + sin * y, -sin * x + cos * y, z];
  const start = turned(from.map((value, k) => value - centre[k]));
  const way = turned(along);
  let [first, last] = [0, Infinity];
  for (let axis = 0; axis < 3; ++axis) {
    const half = 0.5 * extent[axis];
    if (Math.abs(way[axis]) < 1e-12) {
      if (Math.abs(start[axis]) > half) return null;
      continue;
    }
    const [a, b] = [(-half - start[axis]) / way[axis], (half - start[axis]) / way[axis]];
    first = Math.max(first, Math.min(a, b));
    last = Math.min(last, Math.max(a, b));
  }
  return first <= last ? first : null;
}

/** The first of the boxes that a ray enters. @returns {{object: object, distance: number} | null} */
export function boxUnder(ray, objects) {
  let found = null;
  for (const object of objects) {
    const distance = enters(ray, object);
    if (distance !== null && (!found || distance < found.distance)) found = { object, distance };
  }
  return found;
}
