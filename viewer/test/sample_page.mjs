// Pages as docs/report.md lays them down, made from an invented drive: written from the document alone, so that the
// program's pages and the viewer can both be held against it.
import { deflateSync } from 'node:zlib';

/** Random numbers that are the same every time (mulberry32), in [0, 1). */
export function randomSource(seed) {
  let state = seed >>> 0;
  return () => {
    state = (state + 0x6d2b79f5) >>> 0;
    let t = state;
    t = Math.imul(t ^ (t >>> 15), t | 1);
    t ^= t + Math.imul(t ^ (t >>> 7), t | 61);
    return ((t ^ (t >>> 14)) >>> 0) / 4294967296;
  };
}

const base64 = (bytes) => deflateSync(bytes, { level: 6 }).toString('base64');

/**
 * The bytes of a scan.
 * @param {{x: number, y: number, z: number, doppler: number, compensated: number|null, label: number, residual: number|null}[]} points
 */
export function scanBytes(points, unit) {
  const n = points.length;
  const bytes = Buffer.alloc(8 + 12 * n);
  bytes.writeUInt32LE(n, 0);
  bytes.writeFloatLE(unit, 4);
  ['x', 'y', 'z'].forEach((axis, k) => {
    let before = 0;
    points.forEach((point, i) => {
      const value = Math.round(point[axis] / unit);
      const difference = (((value - before) % 65536) + 65536) % 65536;
      bytes.writeUInt16LE(difference, 8 + 2 * (k * n + i));
      before = value;
    });
  });
  const speed = (value) => Math.max(-32767, Math.min(32767, Math.round(value * 100)));
  points.forEach((point, i) => {
    bytes.writeInt16LE(speed(point.doppler), 8 + 2 * (3 * n + i));
    bytes.writeInt16LE(point.compensated === null ? -32768 : speed(point.compensated), 8 + 2 * (4 * n + i));
    bytes.writeUInt8(point.label, 8 + 10 * n + i);
    bytes.writeUInt8(point.residual === null ? 255 : Math.min(254, Math.round(point.residual / 0.005)), 8 + 11 * n + i);
  });
  return bytes;
}

/** The bytes of a static map: points in the world. */
export function mapBytes(points, unit, origin) {
  const n = points.length;
  const bytes = Buffer.alloc(32 + 12 * n);
  bytes.writeUInt32LE(n, 0);
  bytes.writeFloatLE(unit, 4);
  origin.forEach((value, axis) => bytes.writeDoubleLE(value, 8 + 8 * axis));
  for (let axis = 0; axis < 3; ++axis) {
    let before = 0;
    points.forEach((point, i) => {
      const value = Math.round((point[axis] - origin[axis]) / unit);
      bytes.writeInt32LE((value - before) | 0, 32 + 4 * (axis * n + i));
      before = value;
    });
  }
  return bytes;
}

const SPEED = 12; // m/s
const PERIOD = 0.1; // s
const yawAt = (t) => 0.25 * Math.sin(0.4 * t);

/** The sensor's way: a street with gentle curves. */
function drive(count, start) {
  const poses = [];
  let [x, y] = start;
  for (let k = 0; k < count; ++k) {
    const yaw = yawAt(k * PERIOD);
    poses.push({ x, y, z: start[2], yaw });
    x += SPEED * PERIOD * Math.cos(yaw);
    y += SPEED * PERIOD * Math.sin(yaw);
  }
  return poses;
}

const quaternion = (yaw) => [0, 0, Math.sin(yaw / 2), Math.cos(yaw / 2)];
const toSensor = (pose, [x, y, z]) => {
  const [dx, dy] = [x - pose.x, y - pose.y];
  return [Math.cos(pose.yaw) * dx + Math.sin(pose.yaw) * dy, -Math.sin(pose.yaw) * dx + Math.cos(pose.yaw) * dy, z - pose.z];
};

/** Cars beside the way, each with an id, where they are at a time and how fast. */
function cars(start) {
  return Array.from({ length: 6 }, (_, k) => {
    const oncoming = k % 2 === 0;
    return {
      id: 3 + 3 * k,
      speed: oncoming ? -9 - k : 14 + k,
      x: start[0] + (oncoming ? 90 + 45 * k : -10 + 14 * k),
      y: start[1] + (oncoming ? 5.5 : -4.5),
      extent: [4.4, 1.8, 1.5],
    };
  });
}

function surfacePoint(random, pose, start) {
  const ahead = (random() - 0.35) * 120;
  const kind = random();
  const [x, y] = [pose.x + ahead, start[1] + 6 * Math.sin(ahead / 40)];
  if (kind < 0.45) return [x, y + (random() - 0.5) * 24, start[2] - 1.8]; // the ground
  const side = random() < 0.5 ? -1 : 1;
  if (kind < 0.85) return [x, y + side * (12 + (Math.floor(x / 9) % 3)), start[2] - 1.8 + random() * (5 + (Math.floor(x / 13) % 4) * 2)];
  return [Math.round(x / 8) * 8 + 0.15 * (random() - 0.5), y + side * 10, start[2] - 1.8 + random() * 6]; // posts
}

function scanOf(random, pose, start, seconds, list, count) {
  const velocity = [SPEED, 0, 0];
  const points = [];
  const add = ([x, y, z], label, bodySpeed, residual) => {
    const range = Math.hypot(x, y, z);
    if (range < 1 || range > 150) return;
    const along = [x / range, y / range, z / range];
    const own = along.reduce((sum, value, k) => sum + value * velocity[k], 0);
    const moving = along.reduce((sum, value, k) => sum + value * bodySpeed[k], 0);
    const noise = 0.05 * (random() - 0.5);
    points.push({ x, y, z, doppler: moving - own + noise, compensated: random() < 0.01 ? null : moving + noise, label, residual });
  };
  list.forEach((object, k) => {
    for (let i = 0; i < Math.max(12, count / 60); ++i) {
      const [ex, ey, ez] = object.extent;
      const side = random() < 0.5;
      const local = [(side ? random() - 0.5 : -0.5) * ex, (side ? -0.5 : random() - 0.5) * ey, (random() - 0.5) * ez];
      add([object.centre[0] + Math.cos(object.yaw) * local[0] - Math.sin(object.yaw) * local[1],
        object.centre[1] + Math.sin(object.yaw) * local[0] + Math.cos(object.yaw) * local[1], object.centre[2] + local[2]],
      3 + k, object.velocity, null);
    }
  });
  while (points.length < count) {
    const at = toSensor(pose, surfacePoint(random, pose, start));
    const stray = random();
    add(at, stray < 0.03 ? 0 : stray < 0.035 ? 2 : 1, stray < 0.035 && stray >= 0.03 ? [2, 1, 0] : [0, 0, 0], random() < 0.1 ? null : 0.05 * random() * random());
  }
  points.sort((a, b) => Math.floor(a.x / 8) - Math.floor(b.x / 8) || Math.floor(a.y / 8) - Math.floor(b.y / 8) || a.z - b.z);
  return points.slice(0, count);
}

/**
 * One run and its bytes.
 * @param {object} options frames, points per scan, keepEvery (which scans are kept), truth, map, noise of the poses (m),
 *   texts that stand in for the usual ones, unit (m)
 */
export function sampleRun({ name = 'street', frames = 24, points = 1500, keepEvery = 1, seed = 1, truth = true, map = true,
  scans = true, noise = 0.02, method = 'dynamic-icp', start = [482000.5, 5514000.25, 300], texts = {}, unit = 0.005 } = {}) {
  const random = randomSource(seed);
  const true_ = drive(frames, start);
  const poses = [];
  const truePoses = [];
  const egoVelocity = [];
  const distance = [];
  const drift = [];
  const objects = [];
  const details = [];
  const kept = { frames: [], dt: [], whole: [], points: [], of: [] };
  const bytes = [];
  const wander = [0, 0, 0];
  for (let k = 0; k < frames; ++k) {
    const pose = true_[k];
    wander.forEach((_, axis) => { wander[axis] += k === 0 ? 0 : noise * (random() - 0.5); });
    poses.push(pose.x + wander[0], pose.y + wander[1], pose.z + wander[2], ...quaternion(pose.yaw));
    // The truth begins late: nulls before.
    truePoses.push(...(k < 2 ? Array(7).fill(null) : [pose.x, pose.y, pose.z, ...quaternion(pose.yaw)]));
    distance.push(Number((SPEED * PERIOD * k).toFixed(4)));
    drift.push(k < 2 ? null : Math.hypot(...wander));
    egoVelocity.push(SPEED + 0.02 * (random() - 0.5), 0.02 * (random() - 0.5), 0);
    const list = cars(start).map((car) => {
      const centre = toSensor(pose, [car.x + car.speed * k * PERIOD, car.y, start[2] - 1]);
      return { ...car, centre, velocity: [car.speed * Math.cos(pose.yaw), -car.speed * Math.sin(pose.yaw), 0], yaw: -pose.yaw };
    }).filter(({ centre }) => Math.hypot(...centre) < 90);
    objects.push(list.map(({ id, velocity, centre, extent, yaw }) => [id, ...velocity, ...centre, ...extent, (yaw * 180) / Math.PI, 40]));
    // The tangential speed of what drives ahead is not observed; of each car two faces are seen.
    details.push(list.map(({ speed }) => [k + 1, speed < 0, 'sushuu', 0.3, 2.5, 0.1, 0.4, 0.2]));
    if (scans && k % keepEvery === 0) {
      const list2 = scanOf(random, pose, start, k * PERIOD, list, points);
      kept.frames.push(k);
      kept.dt.push(PERIOD);
      kept.whole.push(k % 2 === 0);
      kept.points.push(list2.length);
      kept.of.push(list2.length * (k % 2 === 0 ? 1 : 3));
      bytes.push(scanBytes(list2, unit));
    }
  }
  // To begin with: the first scan with objects, a quarter of the way into the drive.
  const begin = Math.min(frames - 1, Math.max(1, Math.floor(frames / 4)));
  kept.first = Math.max(0, kept.frames.findIndex((frame) => frame >= begin && objects[frame].length > 0));
  const status = Array.from({ length: frames }, (_, k) => (k === 0 ? 'first' : k % 11 === 7 || k % 11 === 8 ? 'degenerate' : k % 17 === 12 ? 'lost' : 'ok'));
  const series = (value) => Array.from({ length: frames }, (_, k) => value(k));
  const jitter = (mean) => mean * (0.6 + 0.8 * random());
  const plot = (id, title, unit_, list, { log = false, fromZero = true, whole = false, levels = [] } = {}) =>
    ({ id, title, unit: unit_, log, from_zero: fromZero, whole_numbers: whole, levels, series: list.map(([n, values, broad = false]) => ({ name: n, values, broad })) });
  const errors = [
    plot('translation_error', 'Translation error', 'mm', [['frame to frame', series((k) => (k < 3 ? null : jitter((1000 * noise) / 3)))]], { log: true, fromZero: false }),
    plot('rotation_error', 'Rotation error', 'deg', [['frame to frame', series((k) => (k < 3 ? null : jitter(noise / 10)))]], { log: true, fromZero: false }),
    plot('position_error', 'Position error', 'm', [['error', drift]]),
    plot('nees', 'Consistency: NEES', '', [['translation', series((k) => (k < 3 ? null : jitter(3)))], ['rotation', series((k) => (k < 3 ? null : jitter(2)))]],
      { log: true, fromZero: false, levels: [[3, 'expected mean']] }),
  ];
  const stages = ['preprocess', 'ego_motion', 'dynamics', 'registration'].map((stage, s) => [stage, series(() => jitter(1 + s))]);
  const run = {
    name,
    facts: [['method', method], ['preset', 'default'], ['version', '0.1.0']],
    command: `dynamic-icp run ${name} --output out --report`,
    warnings: ['7 frames were degenerate: nothing holds the sensor along the way'],
    summary: [
      { key: 'frames', value: String(frames), meaning: 'scans processed', number: frames, better: null },
      { key: 'rte_rmse_m', value: `${((1000 * noise) / 3).toPrecision(3)} mm`, meaning: 'translation error from scan to scan, root mean square', number: noise / 3, better: 'lower' },
      { key: 'rre_rmse_deg', value: `${(noise / 10).toPrecision(3)}°`, meaning: 'rotation error from scan to scan, root mean square', number: noise / 10, better: 'lower' },
      { key: 'fps', value: '102 1/s', meaning: 'scans per second of computing time', number: 100 + seed, better: 'higher' },
    ],
    origin: [['input', `/data/${name}`], ['made at', '2026-03-01T12:00:00Z'], ['threads', '2']],
    configuration: [['registration.kernel', 'geman-mcclure'], ['registration.iterations', '30'], ['registration.distance_m', '2'],
      ['dynamics.min_points', '5'], ['dynamics.threshold_mps', '0.2'], ['preprocess.min_range_m', '1']],
    frames: {
      index: series((k) => 100 + k), seconds: series((k) => Number((k * PERIOD).toFixed(3))), distance, poses, ego_velocity: egoVelocity, status,
      reason: status.map((entry) => (entry === 'degenerate' ? 'planes alone do not hold the position' : entry === 'lost' ? 'nothing fits' : '')),
      lost_directions: status.map((entry) => (entry === 'degenerate' ? ['along x'] : [])),
      objects, object_details: details,
    },
    truth: truth ? { poses: truePoses } : null,
    stretches: truth && frames > 10 ? { length: [1, 2, 5, 10], count: [20, 19, 16, 12], translation: [3, 2, 1.2, 1].map((v) => v * 10 * noise), rotation: [2, 1, 0.5, 0.3].map((v) => v * noise) } : null,
    pictures: [{ title: 'Learned', caption: 'A square', svg: '<svg xmlns="http://www.w3.org/2000/svg" width="40" height="40"><rect width="40" height="40" fill="#0072b2"/></svg>',
      svg_dark: '<svg xmlns="http://www.w3.org/2000/svg" width="40" height="40"><rect width="40" height="40" fill="#56b4e9"/></svg>' }],
    plots: [
      plot('ego_speed', 'Ego speed', 'm/s', [['estimate', series((k) => Math.hypot(...egoVelocity.slice(3 * k, 3 * k + 3)))],
        ...(truth ? [['truth', series(() => SPEED), true]] : [])], { fromZero: false }),
      ...(truth ? errors : []),
      plot('iterations', 'Iterations', '', [['iterations', series(() => 3 + Math.floor(4 * random()))]], { whole: true }),
      plot('fitness', 'Fitness', '', [['share of points', series(() => 0.9 + 0.1 * random())]], { fromZero: false }),
      plot('milliseconds', 'Time', 'ms', [...stages, ['total', series((k) => stages.reduce((sum, [, values]) => sum + values[k], 0))]]),
      plot('dynamic_share', 'Dynamic points', '%', [['of the points used', series(() => jitter(2.4))]]),
      plot('objects', 'Moving objects', '', [['objects', objects.map((list) => list.length)]], { whole: true }),
      plot('degeneracy', 'Information ratio', '', [['smallest / largest', series((k) => (status[k] === 'degenerate' ? 1e-5 : 0.02) * (0.5 + random()))]], { log: true, fromZero: false }),
    ],
    scans: scans ? kept : null,
    map: null, traces: null,
    ...texts,
  };
  let staticMap = null;
  let traces = null;
  if (map) {
    const list = [];
    for (const pose of true_) for (let i = 0; i < 200; ++i) list.push(surfacePoint(random, pose, start));
    run.map = { points: list.length, cell: 0.4 };
    staticMap = mapBytes(list, 0.02, start);
    const moving = true_.flatMap((_, k) => cars(start).map((car) => [car.x + car.speed * k * PERIOD, car.y, start[2] - 1]));
    run.traces = { points: moving.length, cell: 0.1 };
    traces = mapBytes(moving, 0.02, start);
  }
  return { run, scans: bytes, map: staticMap, traces };
}

const escapeText = (text) => text.replaceAll('&', '&amp;').replaceAll('<', '&lt;').replaceAll('>', '&gt;');
const escapeJson = (value) =>
  JSON.stringify(value).replaceAll('<', '\\u003c').replaceAll('>', '\\u003e').replaceAll('&', '\\u0026');

/**
 * The HTML of a page.
 * @param {{kind: string, title: string, parts: ReturnType<typeof sampleRun>[], groups?: object[], tables?: object[], notes?: string[]}} content
 * @param {{script: string, style: string}} viewer
 */
export function pageOf({ kind, title, parts, groups, tables, notes = [] }, viewer) {
  const report = {
    schema: 1, kind, title, generator: 'dynamic-icp 0.1.0', notes, runs: parts.map(({ run }) => run),
    ...(groups ? { groups } : {}), ...(tables ? { tables } : {}),
  };
  const holder = (id, bytes) => `<script type="text/plain" id="${id}">${base64(bytes)}</script>`;
  const bytes = parts.flatMap(({ scans, map, traces }, r) => [
    ...scans.map((scan, k) => ({ first: k === 0 || k === parts[r].run.scans?.first, text: holder(`scan-${r}-${k}`, scan) })),
    ...(map ? [{ first: false, text: holder(`map-${r}`, map) }] : []),
    ...(traces ? [{ first: false, text: holder(`traces-${r}`, traces) }] : []),
  ]);
  const texts = (first) => bytes.filter((entry) => entry.first === first).map(({ text }) => text).join('\n');
  return `<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta http-equiv="Content-Security-Policy" content="default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data: blob:">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>${escapeText(title)}</title>
<style>${viewer.style}</style>
</head>
<body>
<div id="app"><h1>${escapeText(title)}</h1><p>Without JavaScript this page shows its numbers only.</p></div>
<script type="application/json" id="report">${escapeJson(report)}</script>
${texts(true)}
<script>${viewer.script}</script>
${texts(false)}
</body>
</html>
`;
}

/** What a page of several runs says of each: the frames to look at first, and where its own page is. */
function compared(part, colour, page) {
  const [translation, rotation] = ['translation_error', 'rotation_error'].map((id) => part.run.plots.find((plot) => plot.id === id).series[0].values);
  const worst = translation.map((value, frame) => ({ frame, scan: part.run.frames.index[frame], status: part.run.frames.status[frame], translation_mm: value, rotation_deg: rotation[frame] }))
    .filter(({ translation_mm: value }) => value !== null).sort((a, b) => b.translation_mm - a.translation_mm).slice(0, 5);
  Object.assign(part.run, { colour, page, worst });
  return part;
}

/** The content of a page of one run, of a comparison, of a benchmark. */
export const samples = {
  run: (options = {}) => ({ kind: 'run', title: 'street, Dynamic-ICP', parts: [sampleRun(options)], notes: ['Every second scan is thinned to keep the page small.'] }),
  comparison: () => ({
    kind: 'comparison', title: 'street, three methods',
    parts: [
      compared(sampleRun({ name: 'dynamic-icp', noise: 0.02 }), 0, 'run of #1/report.html'),
      compared(sampleRun({ name: 'kiss-icp', method: 'kiss-icp', noise: 0.12, seed: 2, scans: false, map: false }), 1, null),
      compared(sampleRun({ name: 'gicp', method: 'gicp', noise: 0.3, seed: 3, scans: false, map: false }), 2, null),
    ],
    groups: [{ name: 'street', runs: [0, 1, 2], differences: [{ runs: [0, 1], scans: 24, translation_mm: 0.125, rotation_deg: 0 }] }],
  }),
  benchmark: () => ({
    kind: 'benchmark', title: 'Two sequences, two methods',
    parts: ['street', 'tunnel'].flatMap((sequence, s) => ['dynamic-icp', 'kiss-icp'].map((method, m) =>
      compared(sampleRun({ name: method, method, noise: (0.02 + 0.1 * m) * (1 + s), seed: 10 * s + m, scans: false, map: false, frames: 20 + 4 * s }), m, null))),
    groups: [{ name: 'street', runs: [0, 1] }, { name: 'tunnel', runs: [2, 3] }],
    tables: [
      { title: 'Accuracy', caption: 'RTE RMSE in m. Lower is better.', columns: ['sequence', 'dynamic-icp', 'kiss-icp'],
        rows: [['street', '0.007', '0.04'], ['tunnel', '0.007', '0.04']], best: [[false, true, false], [false, true, false]] },
    ],
  }),
};
