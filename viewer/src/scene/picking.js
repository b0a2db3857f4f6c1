// Which point of a scan is under the pointer.

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
