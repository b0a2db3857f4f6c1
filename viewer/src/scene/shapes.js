// Ends of the lines that boxes, arrows and circles are made of: x y z x y z per line.

const EDGES = [[0, 1], [1, 3], [3, 2], [2, 0], [4, 5], [5, 7], [7, 6], [6, 4], [0, 4], [1, 5], [2, 6], [3, 7]];

const sum = (a, b, share) => a.map((value, k) => value + share * b[k]);

/** The twelve edges of a box turned by yaw (rad) about z. */
export function boxEdges({ centre, extent, yaw }) {
  const [cos, sin] = [Math.cos(yaw), Math.sin(yaw)];
  const corner = (k) => {
    const x = (k & 1 ? 0.5 : -0.5) * extent[0];
    const y = (k & 2 ? 0.5 : -0.5) * extent[1];
    const z = (k & 4 ? 0.5 : -0.5) * extent[2];
    return [centre[0] + cos * x - sin * y, centre[1] + sin * x + cos * y, centre[2] + z];
  };
  return EDGES.flatMap(([from, to]) => [...corner(from), ...corner(to)]);
}

/** Ends of the dashes of a line. @param {number} piece m, of a dash and of a gap */
export function dashes(from, to, piece = 0.4) {
  const way = to.map((value, k) => value - from[k]);
  const count = Math.max(1, Math.round((Math.hypot(...way) / piece + 1) / 2));
  return Array.from({ length: count }, (_, k) => [(2 * k) / (2 * count - 1), (2 * k + 1) / (2 * count - 1)])
    .flatMap((shares) => shares.flatMap((share) => sum(from, way, share)));
}

/**
 * A shaft with four barbs, as long as the displacement in `seconds`. Nothing below 0.1 m.
 * `dashed`: the shaft is; it ends in two heads where it would be longer than `most` (m).
 */
export function arrow(from, velocity, { seconds = 1, dashed = false, most = Infinity } = {}) {
  const way = velocity.map((value) => value * seconds);
  const whole = Math.hypot(...way);
  if (!(whole > 0.1)) return [];
  const length = Math.min(whole, most);
  const along = way.map((value) => value / whole);
  const level = Math.hypot(along[0], along[1]);
  const across = level > 1e-6 ? [-along[1] / level, along[0] / level, 0] : [1, 0, 0];
  const up = [
    along[1] * across[2] - along[2] * across[1],
    along[2] * across[0] - along[0] * across[2],
    along[0] * across[1] - along[1] * across[0],
  ];
  const tip = sum(from, along, length);
  const barb = Math.min(1.2, 0.3 * length);
  const barbs = [[across, 0.45], [across, -0.45], [up, 0.3], [up, -0.3]];
  const headAt = (place) => {
    const neck = sum(place, along, -barb);
    return barbs.flatMap(([side, share]) => [place, sum(neck, side, share * barb)]).flat();
  };
  return [
    ...(dashed ? dashes(from, tip) : [...from, ...tip]), ...headAt(tip),
    ...(length < whole ? headAt(sum(tip, along, -0.7 * barb)) : []),
  ];
}

/** A level circle about the origin. */
export function circle(radius, height, pieces = 96) {
  const ends = [];
  for (let k = 0; k < pieces; ++k) {
    for (const at of [k, k + 1]) {
      const angle = (2 * Math.PI * at) / pieces;
      ends.push(radius * Math.cos(angle), radius * Math.sin(angle), height);
    }
  }
  return ends;
}
