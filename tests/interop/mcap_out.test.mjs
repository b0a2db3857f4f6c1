// What convert --to mcap and run --mcap write, read by @mcap/core: every number against the files that they were made
// from. Status 77 (skipped) where the packages are missing. DYNAMIC_ICP_PROGRAM names the program.
import assert from 'node:assert/strict';
import { execFileSync, spawnSync } from 'node:child_process';
import fs from 'node:fs';
import os from 'node:os';
import path from 'node:path';

import { columnsOf, nanoseconds, readMcap, skipWithoutPackages } from './read_mcap.mjs';

skipWithoutPackages();

const program = process.env.DYNAMIC_ICP_PROGRAM;
const folder = fs.mkdtempSync(path.join(os.tmpdir(), 'mcap_out-'));
const run = (...words) => execFileSync(program, words, { cwd: folder, encoding: 'utf8', stdio: ['ignore', 'pipe', 'pipe'] });
const at = (...names) => path.join(folder, ...names);
const of = (file, topic) => file.messages.filter((message) => message.topic === topic);

/// The rows of a TUM file, the stamp in ns as an integer.
function readTum(file) {
  return fs.readFileSync(file, 'utf8').split('\n').filter((line) => line !== '' && !line.startsWith('#')).map((line) => {
    const words = line.split(' ');
    const [seconds, decimals] = words[0].split('.');
    return { ns: BigInt(seconds) * 1_000_000_000n + BigInt((decimals ?? '').padEnd(9, '0')), numbers: words.slice(1).map(Number) };
  });
}

function checkFile(file, source) {
  assert.ok(file.chunks.length >= 1);
  assert.ok(file.chunks.every((chunk) => chunk.compression === 'zstd'));
  assert.equal(file.statistics.messageCount, BigInt(file.messages.length));
  assert.equal(file.statistics.channelCount, file.channels.length);
  assert.equal(file.statistics.schemaCount, file.schemas.length);
  assert.equal(file.statistics.chunkCount, file.chunks.length);
  assert.equal(file.statistics.metadataCount, file.metadata.length);
  for (const channel of file.channels) {
    const messages = of(file, channel.topic);
    assert.equal(file.statistics.channelMessageCounts.get(channel.id), BigInt(messages.length), channel.topic);
    messages.forEach((message, k) => {
      assert.equal(message.sequence, k);
      assert.equal(message.logTime, message.publishTime);
      if (message.value.timestamp != undefined) {
        assert.ok(message.topic === '/ground_truth/path' || nanoseconds(message.value.timestamp) === message.logTime);
      }
    });
  }
  assert.match(file.header.library, /^dynamic-icp /, source);
}

/// Bit by bit: NaN equals NaN, and 0 is not -0.
function assertSame(read, expected, what) {
  assert.equal(read.length, expected.length, what);
  for (let i = 0; i < read.length; ++i) {
    if (!Object.is(read[i], expected[i])) {
      assert.fail(`${what} ${i}: ${read[i]}, expected ${expected[i]}`);
    }
  }
}

function near(read, expected, tolerance, what) {
  assert.ok(Math.abs(read - expected) <= tolerance, `${what}: ${read}, expected ${expected}`);
}

const asVector = (v) => [v.x, v.y, v.z];
const asQuaternion = (q) => [q.x, q.y, q.z, q.w];

function rotate([x, y, z, w], p) {
  const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
  const c = cross([x, y, z], p).map((value, k) => value + w * p[k]);
  return cross([x, y, z], c).map((value, k) => p[k] + 2 * value);
}

/// With a mounting on a vehicle, or none.
async function convertedDrive(mounting) {
  const output = mounting ? 'mounted.mcap' : 'drive.mcap';
  if (mounting) {
    fs.writeFileSync(at('drive', 'calibration.json'), JSON.stringify({ T_V_to_S: mounting }));
  }
  run('convert', 'drive', '--to', 'mcap', '--output', output, '--quiet');
  const file = await readMcap(at(output));
  checkFile(file, 'convert');
  const truth = readTum(at('drive', 'ref_poses.txt'));
  const clouds = of(file, '/points');
  assert.equal(clouds.length, truth.length);
  clouds.forEach(({ value, logTime }, k) => {
    assert.equal(logTime, truth[k].ns, 'timestamps are exact');
    const name = `${String(k + 1).padStart(5, '0')}.bin`;
    const bytes = fs.readFileSync(at('drive', 'point_clouds', name));
    const numbers = new Float32Array(bytes.buffer, bytes.byteOffset, bytes.length / 4);
    const columns = columnsOf(value);
    ['x', 'y', 'z', 'doppler'].forEach((column, c) => {
      assertSame(columns[column], Array.from(numbers.filter((_, i) => i % 4 === c)), `${name} ${column}`);
    });
    const times = fs.readFileSync(at('drive', 'times', name));
    assertSame(columns.time_offset_s, Array.from(new Float32Array(times.buffer, times.byteOffset, times.length / 4)), name);
    assert.equal(value.frame_id, 'sensor');
    assert.deepEqual(asQuaternion(value.pose.orientation), [0, 0, 0, 1]);
  });
  const poses = of(file, '/ground_truth/pose');
  const q_vehicle_sensor = mounting ? asQuaternion(mounting.quaternion) : [0, 0, 0, 1];
  poses.forEach(({ value, logTime }, k) => {
    // The poses of this layout are those of the vehicle.
    assert.equal(logTime, truth[k].ns);
    const q = truth[k].numbers.slice(3);
    const lever = rotate(q, mounting ? asVector(mounting.translation) : [0, 0, 0]);
    asVector(value.pose.position).forEach((number, axis) => near(number, lever[axis] + truth[k].numbers[axis], 1e-9, 'truth'));
    const forward = rotate(q, rotate(q_vehicle_sensor, [1, 0, 0]));
    rotate(asQuaternion(value.pose.orientation), [1, 0, 0]).forEach((number, axis) => near(number, forward[axis], 1e-9, 'truth'));
    assert.equal(value.frame_id, 'world');
  });
  assert.equal(of(file, '/ground_truth/path')[0].value.poses.length, truth.length);
  // The chain of frames: world, base_link where it is known, sensor.
  of(file, '/tf').forEach(({ value }, k) => {
    const [transform] = value.transforms;
    assert.deepEqual([transform.parent_frame_id, transform.child_frame_id], ['world', mounting ? 'base_link' : 'sensor']);
    asVector(transform.translation).forEach((number, axis) => near(number, truth[k].numbers[axis], 1e-9, 'tf'));
  });
  if (mounting) {
    const fixed = of(file, '/tf_static')[0].value.transforms;
    assert.deepEqual(fixed.map((t) => [t.parent_frame_id, t.child_frame_id]), [['base_link', 'sensor']]);
    assert.deepEqual(asVector(fixed[0].translation), asVector(mounting.translation));
    assert.deepEqual(of(file, '/calibration').map(({ value }) => value.T_V_to_S), [mounting]);
  } else {
    assert.ok(!file.channels.some((channel) => ['/tf_static', '/calibration'].includes(channel.topic)));
  }
  const again = at('again.mcap');
  run('convert', 'drive', '--to', 'mcap', '--output', again, '--force', '--quiet');
  assert.ok(fs.readFileSync(again).equals(fs.readFileSync(at(output))), 'the same bytes again');
}

/// All columns of a rig: its sensors, lines, ... of any type, and where the sensors sit.
async function convertedRig() {
  run('simulate', 'street', '--output', 'rig', '--layout', 'aevascenes', '--frames', '2', '--seed', '3', '--quiet');
  run('convert', 'rig', '--to', 'mcap', '--output', 'rig.mcap', '--quiet');
  run('convert', 'rig', '--to', 'pcd', '--output', 'rig_pcd', '--quiet');
  const file = await readMcap(at('rig.mcap'));
  checkFile(file, 'rig');
  const names = fs.readdirSync(at('rig_pcd')).filter((name) => name.endsWith('.pcd')).sort();
  const clouds = of(file, '/points');
  assert.equal(clouds.length, names.length);
  names.forEach((name, k) => {
    assert.equal(clouds[k].logTime, BigInt(path.parse(name).name));
    const bytes = fs.readFileSync(at('rig_pcd', name));
    const header = {};
    let offset = 0;
    while (header.DATA == undefined) {
      const end = bytes.indexOf('\n', offset);
      const [key, ...values] = bytes.toString('latin1', offset, end).split(' ');
      header[key] = values;
      offset = end + 1;
    }
    const columns = columnsOf(clouds[k].value);
    assert.deepEqual(Object.keys(columns), header.FIELDS);
    const stride = header.SIZE.reduce((sum, size) => sum + Number(size), 0);
    const readers = { F4: 'readFloatLE', F8: 'readDoubleLE', U1: 'readUInt8', U4: 'readUInt32LE', I4: 'readInt32LE' };
    let inside = 0;
    header.FIELDS.forEach((field, c) => {
      const read = readers[header.TYPE[c] + header.SIZE[c]];
      const expected = [];
      for (let row = 0; row < Number(header.POINTS[0]); ++row) {
        expected.push(bytes[read](offset + row * stride + inside));
      }
      assertSame(columns[field], expected, field);
      inside += Number(header.SIZE[c]);
    });
  });
  assert.deepEqual(of(file, '/calibration')[0].value, JSON.parse(fs.readFileSync(at('rig_pcd', 'calibration.json'), 'utf8')));
}

async function recordedRun() {
  run('run', 'drive', '--output', 'run', '--mcap', 'run.mcap', '--save-labels', '--save-kitti', 'kitti.txt', '--quiet');
  const file = await readMcap(at('run.mcap'));
  checkFile(file, 'run');
  const trajectory = readTum(at('run', 'trajectory.tum'));
  const lines = (name) => fs.readFileSync(at('run', name), 'utf8').trim().split('\n').map((line) => JSON.parse(line));
  const frames = lines('frames.jsonl');
  const objects = lines('objects.jsonl');

  const transforms = of(file, '/tf');
  assert.equal(transforms.length, trajectory.length);
  transforms.forEach(({ value, logTime }, k) => {
    const [transform] = value.transforms;
    assert.deepEqual([transform.parent_frame_id, transform.child_frame_id], ['world', 'sensor']);
    assert.equal(logTime, trajectory[k].ns);
    const read = [...asVector(transform.translation), ...asQuaternion(transform.rotation)];
    const sign = Math.sign(read[6] * trajectory[k].numbers[6]);
    read.forEach((number, c) => near(c < 3 ? number : sign * number, trajectory[k].numbers[c], 1e-12, 'pose'));
  });
  of(file, '/path').forEach(({ value }, k) => {
    assert.equal(value.poses.length, k + 1);
    near(value.poses[k].position.x, trajectory[k].numbers[0], 1e-12, 'path');
  });
  const truth = of(file, '/ground_truth/path');
  assert.equal(truth.length, 1);
  near(Math.hypot(...asVector(truth[0].value.poses[0].position)), 0, 1e-9, 'the first pose of the ground truth');
  assert.ok(Math.hypot(...asVector(truth[0].value.poses.at(-1).position).map((number, axis) =>
    number - trajectory.at(-1).numbers[axis])) < 0.1, 'the ground truth lies where the run is');

  let moving = 0;
  of(file, '/points').forEach(({ value, logTime }, k) => {
    assert.equal(logTime, trajectory[k].ns);
    const name = `${String(k + 1).padStart(5, '0')}.bin`;
    const bytes = fs.readFileSync(at('drive', 'point_clouds', name));
    const raw = new Float32Array(bytes.buffer, bytes.byteOffset, bytes.length / 4);
    const saved = fs.readFileSync(at('run', 'labels', name));
    const labels = new Int32Array(saved.buffer, saved.byteOffset, saved.length / 4);
    const columns = columnsOf(value);
    assertSame(columns.doppler, Array.from(raw.filter((_, i) => i % 4 === 3)), 'doppler');
    const v = frames[k].ego_velocity;
    let outliers = 0;
    columns.label.forEach((label, i) => {
      assert.ok(label === labels[i] || (label === -2 && labels[i] === -1), `label ${label} of ${labels[i]}`);
      const p = [raw[4 * i], raw[4 * i + 1], raw[4 * i + 2]];
      const r = Math.hypot(...p);
      const expected = raw[4 * i + 3] + (p[0] * v[0] + p[1] * v[1] + p[2] * v[2]) / r - frames[k].doppler_bias;
      // The velocity changes during the scan; frames.jsonl has that of its middle.
      near(columns.doppler_compensated[i], expected, 0.5, 'compensated Doppler');
      outliers += label === 0 && Math.abs(columns.doppler_compensated[i]) > 0.5 ? 1 : 0;
      assert.ok(label !== -2 || Math.abs(columns.doppler_compensated[i]) > 0.5);
      moving += label > 0 ? 1 : 0;
      // Deskewed: not farther from the measured point than the sensor and an object go in a scan.
      const shift = Math.hypot(columns.x[i] - p[0], columns.y[i] - p[1], columns.z[i] - p[2]);
      assert.ok(shift < 0.1 * (Math.hypot(...v) + 30) + 0.02 * r, `point ${i} moved by ${shift} m`);
    });
    assert.ok(outliers < 0.02 * columns.label.length);
  });
  assert.ok(moving > 0);

  let boxes = 0;
  of(file, '/objects').forEach(({ value }, k) => {
    assert.equal(value.deletions.length, 1);
    assert.equal(value.deletions[0].type, 1, 'all earlier ones vanish');
    assert.deepEqual(value.entities.map((entity) => Number(entity.id)), objects[k].objects.map((object) => object.id));
    value.entities.forEach((entity, n) => {
      const expected = objects[k].objects[n];
      assert.equal(entity.frame_id, 'sensor');
      near(Number(nanoseconds(entity.lifetime)), 1.5e8, 1e6, 'lifetime');
      asVector(entity.cubes[0].pose.position).forEach((number, axis) => near(number, expected.centroid[axis], 1e-9, 'box'));
      const speed = Math.hypot(...expected.velocity);
      assert.equal(entity.texts[0].text, `${expected.id} · ${speed.toFixed(1)} m/s`);
      if (speed > 0.31) {
        const [arrow] = entity.arrows;
        near(arrow.shaft_length + arrow.head_length, speed, 1e-9, 'arrow');
        rotate(asQuaternion(arrow.pose.orientation), [1, 0, 0]).forEach((number, axis) =>
          near(number, expected.velocity[axis] / speed, 1e-9, 'direction of the arrow'));
      }
      ++boxes;
    });
  });
  assert.ok(boxes > 0);

  of(file, '/odometry/state').forEach(({ value }, k) => {
    const expected = frames[k];
    assert.equal(value.status, expected.status);
    assert.equal(value.reason, expected.reason);
    assert.equal(value.converged, expected.converged);
    assert.equal(value.points, expected.points);
    assert.deepEqual(asVector(value.ego_velocity_mps), expected.ego_velocity);
    near(value.speed_mps, Math.hypot(...expected.ego_velocity), 1e-12, 'speed');
    near(value.ego_velocity_sigma_mps.y, Math.sqrt(expected.ego_velocity_covariance[1][1]), 1e-12, 'deviation');
    if (expected.pose_covariance != null) {
      assert.deepEqual(value.pose_covariance, expected.pose_covariance.flat());
      near(value.position_sigma_m.z, Math.sqrt(expected.pose_covariance[5][5]), 1e-12, 'deviation of the position');
    }
    assert.ok(value.position_error_m < 0.1);
  });

  // The layout names topics and fields that are there.
  const layout = JSON.parse(fs.readFileSync(at('foxglove_layout.json'), 'utf8'));
  const topics = new Set(file.channels.map((channel) => channel.topic));
  for (const panel of Object.values(layout.configById)) {
    Object.keys(panel.topics ?? {}).forEach((topic) => assert.ok(topics.has(topic), topic));
    for (const { value } of panel.paths ?? []) {
      const [topic, ...keys] = value.split('.');
      const found = keys.reduce((object, key) => object[key], of(file, topic).at(-1).value);
      assert.ok(['number', 'string'].includes(typeof found), value);
    }
  }
  assert.equal(layout.configById['3D!dynamic-icp'].followTf, 'sensor');

  const kitti = fs.readFileSync(at('kitti.txt'), 'utf8').trim().split('\n').map((line) => line.split(' ').map(Number));
  assert.equal(kitti.length, trajectory.length);
  kitti.forEach((numbers, k) => {
    assert.equal(numbers.length, 12);
    [0, 1, 2].forEach((axis) => {
      near(numbers[4 * axis + 3], trajectory[k].numbers[axis], 1e-12, 'KITTI');
      const column = rotate(trajectory[k].numbers.slice(3), [0, 1, 2].map((other) => (other === axis ? 1 : 0)));
      [0, 1, 2].forEach((row) => near(numbers[4 * row + axis], column[row], 1e-12, 'KITTI'));
    });
  });
}

/// A method without objects, twists or labels.
async function otherMethod() {
  run('run', 'drive', '--output', 'other', '--mcap', 'other.mcap', '--method', 'point-to-plane', '--max-frames', '2', '--quiet');
  const file = await readMcap(at('other.mcap'));
  checkFile(file, 'point-to-plane');
  assert.ok(of(file, '/objects').every(({ value }) => value.entities.length === 0));
  assert.ok(of(file, '/points').every(({ value }) => columnsOf(value).label.every((label) => label !== -2)));
  assert.ok(Number.isNaN(of(file, '/odometry/state')[0].value.position_sigma_m.x));
}

try {
  run('simulate', 'city', '--output', 'drive', '--frames', '8', '--seed', '4', '--quiet');
  await convertedDrive();
  await convertedRig();
  await recordedRun();
  await otherMethod();
  await convertedDrive({ translation: { x: 1.4, y: 0, z: 1.9 }, quaternion: { w: 0.8, x: 0, y: 0, z: 0.6 } });
} finally {
  fs.rmSync(folder, { recursive: true });
}
console.log('passed');
