// Ends of the lines that boxes, arrows and circles are made of: x y z x y z per line.

const EDGES = [[0, 1], [1, 3], [3, 2], [2, 0], [4, 5], [5, 7], [7, 6], [6, 4], [0, 4], [1, 5], [2, 6], [3, 7]];

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

const sum = (a, b, share) => a.map((value, k) => value + share * b[k]);

/** A shaft with four barbs, as long as the way in `seconds`. Nothing below 0.1 m. */
export function arrow(from, velocity, seconds = 1) {
  const way = velocity.map((value) => value * seconds);
  const length = Math.hypot(...way);
  if (!(length > 0.1)) return [];
  const along = way.map((value) => value / length);
  const level = Math.hypot(along[0], along[1]);
  const across = level > 1e-6 ? [-along[1] / level, along[0] / level, 0] : [1, 0, 0];
  const up = [
    along[1] * across[2] - along[2] * across[1],
    along[2] * across[0] - along[0] * across[2],
    along[0] * across[1] - along[1] * across[0],
  ];
  const tip = sum(from, along, length);
  const barb = Math.min(1.2, 0.3 * length);
  const neck = sum(tip, along, -barb);
  const barbs = [[across, 0.45], [across, -0.45], [up, 0.3], [up, -0.3]];
  return [from, tip, ...barbs.flatMap(([side, share]) => [tip, sum(neck, side, share * barb)])].flat();
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
