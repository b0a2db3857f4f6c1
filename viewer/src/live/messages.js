// What the messages of a run say (docs/live.md), in the words of the rest of the viewer.
import { UNKNOWN } from '../bytes.js';
import { fieldsOf, listOf, textOf, valuesOf } from './protobuf.js';

const FLOAT32 = 7;
const INT32 = 6;
const MOST_OBJECTS = 250; // labels of points are bytes
const DOUBTFUL = 0.5; // opacity; arrows of which only the part along the line of sight is known are fainter

/** As many of the fields 1, 2, ... as asked for; what is left out is 0. */
const numbersOf = (view, count) => {
  const values = view ? valuesOf(view) : {};
  return Array.from({ length: count }, (_, k) => values[k + 1] ?? 0);
};

/** Position and orientation: [x y z qx qy qz qw]. */
const poseOfMessage = (view) => {
  const { 1: position, 2: orientation } = view ? valuesOf(view) : {};
  return [...numbersOf(position, 3), ...numbersOf(orientation, 4)];
};

/** A vector turned by a unit quaternion. */
function turned([x, y, z, w], [a, b, c]) {
  const [s, t, u] = [2 * (y * c - z * b), 2 * (z * a - x * c), 2 * (x * b - y * a)];
  return [a + w * s + y * u - z * t, b + w * t + z * s - x * u, c + w * u + x * t - y * s];
}

/** foxglove.FrameTransforms: the pose of the sensor in the world, or null. */
export function decodeTransforms(view) {
  const [first] = listOf(view, 1);
  if (!first) return null;
  const { 4: translation, 5: rotation } = valuesOf(first);
  return [...numbersOf(translation, 3), ...numbersOf(rotation, 4)];
}

/** foxglove.PosesInFrame: poses of 7 numbers, one behind the other. */
export const decodePath = (view) => listOf(view, 3).flatMap(poseOfMessage);

/**
 * foxglove.PointCloud with the columns of a run.
 * @returns {import('../bytes.js').Scan & {ids: number[]}} `ids` of the objects that the labels from 3 on mean
 */
export function decodeCloud(view) {
  const columns = {};
  let stride = 0;
  let data = new DataView(new ArrayBuffer(0));
  for (const [number, value] of fieldsOf(view)) {
    if (number === 4) stride = value;
    if (number === 6) data = value;
    if (number !== 5) continue;
    const { 1: name, 2: offset = 0, 3: type } = valuesOf(value);
    columns[textOf(name)] = { offset, type };
  }
  const count = stride > 0 ? Math.floor(data.byteLength / stride) : 0;
  const column = (name, type) => {
    if (columns[name]?.type !== type) throw new Error(`the points have no column '${name}' of the type that is expected`);
    return columns[name].offset;
  };
  const scan = {
    count, positions: new Float32Array(3 * count), doppler: new Float32Array(count), compensated: new Float32Array(count),
    residual: new Float32Array(count).fill(UNKNOWN), label: new Uint8Array(count), ids: [],
  };
  if (count === 0) return scan;
  const [x, y, z, doppler, compensated] = ['x', 'y', 'z', 'doppler', 'doppler_compensated'].map((name) => column(name, FLOAT32));
  const label = column('label', INT32);
  const places = new Map();
  for (let i = 0, at = 0; i < count; ++i, at += stride) {
    scan.positions[3 * i] = data.getFloat32(at + x, true);
    scan.positions[3 * i + 1] = data.getFloat32(at + y, true);
    scan.positions[3 * i + 2] = data.getFloat32(at + z, true);
    scan.doppler[i] = data.getFloat32(at + doppler, true);
    const own = data.getFloat32(at + compensated, true);
    scan.compensated[i] = Number.isFinite(own) ? own : UNKNOWN;
    const id = data.getInt32(at + label, true);
    if (id > 0 && !places.has(id) && places.size < MOST_OBJECTS) {
      places.set(id, 3 + places.size);
      scan.ids.push(id);
    }
    scan.label[i] = id === 0 ? 1 : id > 0 ? places.get(id) ?? 2 : id === -1 ? 0 : 2;
  }
  return scan;
}

/** foxglove.SceneUpdate: boxes with their velocities, in the sensor frame. */
export function decodeObjects(view) {
  return listOf(view, 2).map((entity) => {
    const { 3: id, 7: arrow, 8: cube } = valuesOf(entity);
    const { 1: cubePose, 2: size } = cube ? valuesOf(cube) : {};
    const [cx, cy, cz, qx, qy, qz, qw] = poseOfMessage(cubePose);
    const { 1: arrowPose, 2: shaft = 0, 4: head = 0, 6: colour } = arrow ? valuesOf(arrow) : {};
    const orientation = arrow ? poseOfMessage(arrowPose).slice(3) : [0, 0, 0, 1];
    return {
      id: Number(textOf(id)), centre: [cx, cy, cz], extent: numbersOf(size, 3),
      yaw: Math.atan2(2 * (qw * qz + qx * qy), 1 - 2 * (qy * qy + qz * qz)),
      velocity: turned(orientation, [shaft + head, 0, 0]),
      observed: !colour || numbersOf(colour, 4)[3] > DOUBTFUL,
    };
  });
}

const finite = (value) => (Number.isFinite(value) ? value : null);

/** dynamic_icp.OdometryState; null: not stated. */
export function decodeState(view) {
  const all = valuesOf(view);
  const vector = (number) => numbersOf(all[number], 3).map(finite);
  const length = (values) => (values.includes(null) ? null : Math.hypot(...values));
  return {
    status: textOf(all[2]), reason: textOf(all[3]), speed: finite(all[5] ?? 0), velocity: vector(6),
    speedSigma: length(vector(7)), positionSigma: length(vector(8)), rotationSigma: length(vector(9)),
    points: all[14] ?? 0, used: all[15] ?? 0, moving: all[16] ?? 0, objects: all[17] ?? 0, iterations: all[18] ?? 0,
    inlierRmse: finite(all[19] ?? 0), time: finite(all[20] ?? 0), error: finite(all[21] ?? 0), latency: finite(all[22] ?? NaN),
  };
}
