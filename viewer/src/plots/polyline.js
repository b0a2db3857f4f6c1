// A series as a line of pixels: not more than four points per column, whatever the number of values.

/**
 * Calls `move` and `line` along the series; where a value is missing the line breaks, and a value without neighbours
 * becomes a dot.
 * @param {ArrayLike<number>} xs places @param {ArrayLike<number|null>} ys places, null or NaN where there is none
 */
export function tracePolyline(xs, ys, { move, line, dot }) {
  let started = false; // within an unbroken piece
  let length = 0;
  let column = null;

  const flush = () => {
    if (!column) return;
    const { x, first, low, high, last } = column;
    for (const y of column.lowFirst ? [first, low, high, last] : [first, high, low, last]) {
      if (!started) move(x, y);
      else line(x, y);
      started = true;
    }
    column = null;
  };
  const end = () => {
    const lone = length === 1 ? column : null;
    flush();
    if (lone) dot(lone.x, lone.last);
    started = false;
    length = 0;
  };
  for (let i = 0; i < xs.length; ++i) {
    const y = ys[i];
    if (y === null || y === undefined || Number.isNaN(y)) {
      end();
      continue;
    }
    ++length;
    const x = xs[i];
    if (column && Math.floor(column.x) === Math.floor(x)) {
      if (y < column.low) [column.low, column.lowFirst] = [y, false];
      if (y > column.high) [column.high, column.lowFirst] = [y, true];
      column.last = y;
    } else {
      flush();
      column = { x, first: y, low: y, high: y, last: y, lowFirst: true };
    }
  }
  end();
}
