import assert from 'node:assert/strict';
import test from 'node:test';
import { decodeScan } from '../src/bytes.js';
import { closest, facingOf, headingInSensor, keptScan, lastNotAbove, troubledRanges } from '../src/runs.js';
import { fromAnchor, toAnchor } from '../src/scene/camera_rig.js';
import { placeBoxes } from '../src/scene/labels.js';
import { pathSegments } from '../src/scene/paths.js';
import { rulerText } from '../src/scene/overlay.js';
import { boxUnder, enters, pointUnder, rayThrough } from '../src/scene/picking.js';
import { MOST_CROSSES, predictPoints } from '../src/scene/predicted_points.js';
import { categoriesOf } from '../src/scene/scan_points.js';
import { arrow, boxEdges, circle } from '../src/scene/shapes.js';
import { createScanCache } from '../src/scan_cache.js';
import { scanBytes } from './sample_page.mjs';

const near = (a, b) => a.forEach((value, k) => assert.ok(Math.abs(value - b[k]) < 1e-6, `${a} is not ${b}`));

test('a box has twelve edges of its lengths, its corners turned about its centre', () => {
  const edges = boxEdges({ centre: [10, 5, 1], extent: [4, 2, 1.5], yaw: Math.PI / 6 });
  const lengths = [];
  for (let k = 0; k < edges.length; k += 6) lengths.push(Math.hypot(...[0, 1, 2].map((axis) => edges[k + axis] - edges[k + 3 + axis])));
  near(lengths.sort(), [1.5, 1.5, 1.5, 1.5, 2, 2, 2, 2, 4, 4, 4, 4]);
  const front = [10 + 2 * Math.cos(Math.PI / 6) - Math.sin(Math.PI / 6), 5 + 2 * Math.sin(Math.PI / 6) + Math.cos(Math.PI / 6), 1.75];
  const corners = Array.from({ length: 24 }, (_, k) => edges.slice(3 * k, 3 * k + 3));
  assert.ok(corners.some((corner) => Math.hypot(...corner.map((value, k) => value - front[k])) < 1e-9));
});

test('an arrow ends where the velocity leads in a second; what stands has none', () => {
  const ends = arrow([1, 2, 3], [3, 4, 0]);
  near(ends.slice(0, 6), [1, 2, 3, 4, 6, 3]);
  assert.deepEqual(arrow([0, 0, 0], [0, 0, 0]), []);
  assert.ok(arrow([0, 0, 0], [0, 0, 5]).every(Number.isFinite));
});

test('an arrow that would be too long ends early, in two heads; a dashed one has gaps in its shaft', () => {
  const long = arrow([0, 0, 0], [100, 0, 0], { most: 20 });
  near(long.slice(0, 6), [0, 0, 0, 20, 0, 0]);
  assert.equal(long.length / 6, 1 + 4 + 4);
  assert.equal(arrow([0, 0, 0], [10, 0, 0], { most: 20 }).length / 6, 1 + 4);
  const dashed = arrow([0, 0, 0], [10, 0, 0], { dashed: true });
  const shaft = dashed.slice(0, dashed.length - 4 * 6);
  assert.ok(shaft.length / 6 > 5);
  near(shaft.slice(0, 3), [0, 0, 0]);
  near(shaft.slice(-3), [10, 0, 0]);
  for (let k = 6; k < shaft.length; k += 6) assert.ok(shaft[k] > shaft[k - 3] + 0.1, 'a gap before every dash');
});

test('a ray finds the box it enters first, turned boxes too', () => {
  const box = (x, yaw = 0) => ({ id: x, centre: [x, 0, 0], extent: [4, 2, 1.5], yaw });
  const ray = { from: [0, 0, 0], along: [1, 0, 0] };
  assert.equal(enters(ray, box(10)), 8);
  assert.ok(Math.abs(enters(ray, box(10, Math.PI / 2)) - 9) < 1e-9, 'across the ray it is 2 m deep');
  assert.equal(enters(ray, { ...box(10), centre: [10, 1.5, 0] }), null);
  assert.equal(enters(ray, box(-10)), null, 'behind');
  assert.equal(enters({ from: [10, 0, 0], along: [0, 0, 1] }, box(10)), 0, 'from within');
  assert.equal(boxUnder(ray, [box(30), box(10), box(-5)]).object.id, 10);
  assert.equal(boxUnder(ray, []), null);
});

test('the ray through a pixel is that of the projection undone', () => {
  // Without perspective: 100 pixels are 20 m, the eye looks along -z.
  const fromClip = [10, 0, 0, 0, 0, 10, 0, 0, 0, 0, -5, 0, 3, 0, 0, 1];
  const { from, along } = rayThrough(fromClip, { x: 75, y: 50, width: 100, height: 100 });
  near(from, [8, 0, 5]);
  near(along, [0, 0, -1]);
});

test('a ruler tells the distance and its parts', () => {
  assert.equal(rulerText([1, 1, 0], [4, 5, 0]), '5 m (Δx 3, Δy 4 m)');
  assert.equal(rulerText([0, 0, 0], [2, -1, 2]), '3 m (Δx 2, Δy −1, Δz 2 m)');
});

test('a circle closes and keeps its radius', () => {
  const ends = circle(20, -1.8);
  near(ends.slice(0, 3), ends.slice(-3));
  for (let k = 0; k < ends.length; k += 3) assert.ok(Math.abs(Math.hypot(ends[k], ends[k + 1]) - 20) < 1e-9 && ends[k + 2] === -1.8);
});

const point = (x, label) => ({ x, y: 1, z: 0, doppler: 0, compensated: 0, label, residual: 0 });
const scan = (() => {
  const bytes = scanBytes([point(1, 1), point(2, 3), point(3, 4), point(4, 2), point(5, 9)], 0.5);
  return decodeScan(bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.byteLength));
})();

test('predicted points are those of objects, moved by velocity times time', () => {
  const { measured, predicted, positions } = predictPoints(scan, [{ velocity: [10, 0, 0] }, { velocity: [0, -5, 1] }], 0.1);
  assert.deepEqual([measured, predicted], [2, 2]);
  near([...positions], [2, 1, 0, 3, 1, 0, 3, 1, 0, 3, 0.5, 0.1]);
});

test('of an object with many points some are predicted, from all over it', () => {
  const label = new Uint8Array(1000).fill(3);
  const many = { count: 1000, label, positions: Float32Array.from({ length: 3000 }, (_, i) => (i % 3 ? 0 : i / 3)) };
  const { measured, predicted, positions } = predictPoints(many, [{ velocity: [0, 20, 0] }], 0.5);
  assert.deepEqual([measured, predicted], [1000, MOST_CROSSES]);
  const xs = [...positions.slice(3000)].filter((_, i) => i % 3 === 0);
  xs.forEach((x, k) => assert.ok(Math.abs(x - (1000 * k) / MOST_CROSSES) < 2));
  assert.ok([...positions.slice(3000)].every((value, i) => i % 3 !== 1 || value === 10));
});

test('points take the colour of their object by its id; a label without object is moving', () => {
  assert.deepEqual([...categoriesOf(scan.label, [10, 7], new Uint8Array(5))], [1, 3 + 4, 3 + 1, 2, 2]);
});

test('a path breaks where a pose is missing and knows the frame of every piece', () => {
  const pose = (x) => [x, 0, 0, 0, 0, 0, 1];
  const none = Array(7).fill(null);
  const { ends, until } = pathSegments([...pose(1), ...pose(2), ...none, ...pose(4), ...pose(6)], 5, [1, 0, 0]);
  assert.deepEqual(until, [1, 4]);
  assert.deepEqual(ends, [0, 0, 0, 1, 0, 0, 3, 0, 0, 5, 0, 0]);
});

test('the camera comes along: what is relative to the sensor stays so', () => {
  const anchor = { place: [100, -50, 3], yaw: 0.7 };
  for (const mode of ['follow', 'top', 'free']) near(toAnchor(mode, anchor, fromAnchor(mode, anchor, [-20, 3, 9])), [-20, 3, 9]);
  near(fromAnchor('follow', { place: [1, 1, 0], yaw: Math.PI / 2 }, [-10, 0, 5]), [1, -9, 5]);
  near(fromAnchor('top', { place: [1, 1, 0], yaw: Math.PI / 2 }, [-10, 0, 5]), [-9, 1, 5]);
});

test('of labels that would cover each other the nearest stands, a picked one before it, and no other is hidden', () => {
  const box = (left, distance, rank = 1, top = 0) => ({ left, top, width: 60, height: 16, rank, distance });
  assert.deepEqual(placeBoxes([box(0, 30), box(40, 10), box(200, 80)]), [false, true, true]);
  assert.deepEqual(placeBoxes([box(0, 30, 0), box(40, 10), box(200, 80)]), [true, false, true]);
  // The middle one is hidden by the nearest, so the far one that only the middle one would cover stands.
  assert.deepEqual(placeBoxes([box(0, 10), box(40, 20), box(80, 30)]), [true, false, true]);
  assert.deepEqual(placeBoxes([box(0, 10), box(0, 20, 1, 10), box(0, 30, 1, 30)]), [true, false, true]);
  assert.deepEqual(placeBoxes([]), []);
});

test('the point under the pointer is the near one of those it hits', () => {
  // Looking along z with w = z: x and y are halved at twice the distance.
  const matrix = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 1, 0, 0, 0, 0];
  const positions = Float32Array.from([0, 0, 10, 0, 0, 4, 2, 0, 4, 0, 0, -3]);
  const pointer = { x: 50, y: 50, width: 100, height: 100, reach: 5 };
  assert.equal(pointUnder(positions, 4, matrix, pointer), 1);
  assert.equal(pointUnder(positions, 4, matrix, pointer, (i) => i !== 1), 0);
  assert.equal(pointUnder(positions, 4, matrix, { ...pointer, x: 75 }), 2);
  assert.equal(pointUnder(positions, 4, matrix, { ...pointer, x: 10 }), -1);
});

test('frames find their kept scan and the frames that need attention', () => {
  const run = { scans: { frames: [2, 5] }, frames: { status: ['first', 'ok', 'degenerate', 'degenerate', 'lost', 'ok'] } };
  assert.deepEqual([0, 2, 4, 5, 9].map((frame) => keptScan(run, frame)), [null, 0, 0, 1, 1]);
  assert.equal(keptScan({ scans: null }, 3), null);
  assert.deepEqual(troubledRanges(run), [{ status: 'degenerate', from: 2, to: 3 }, { status: 'lost', from: 4, to: 4 }]);
  assert.deepEqual([-1, 0, 3, 99].map((value) => lastNotAbove([0, 2, 4], value)), [-1, 0, 1, 2]);
  assert.deepEqual([-5, 0.9, 1.1, 3.1, 77].map((value) => closest([0, 2, 4], value)), [0, 0, 1, 2, 2]);
});

/** Points on an arc about the sensor, degrees; the farther the more to its end. */
const arc = (from, to) => Float32Array.from(Array.from({ length: 121 }, (_, k) => {
  const angle = ((from + ((to - from) * k) / 121) * Math.PI) / 180;
  return [(5 + k) * Math.cos(angle), (5 + k) * Math.sin(angle), -1];
}).flat());

test('the points of a scan face their middle direction; those all around face none', () => {
  assert.ok(Math.abs(facingOf(arc(-60, 60))) < 0.02);
  assert.ok(Math.abs(facingOf(arc(30, 150)) - Math.PI / 2) < 0.02);
  assert.equal(facingOf(arc(0, 360)), null);
  assert.equal(facingOf(new Float32Array(0)), null);
  assert.equal(facingOf(new Float32Array(9)), null);
});

test('the sensor looks where it drives if it drives into its points, else at its points, else ahead', () => {
  const run = (velocity) => ({ frames: { index: [0, 1], ego_velocity: [...velocity, ...velocity] } });
  const heading = (velocity, facing) => headingInSensor(run(velocity), facing);
  assert.ok(Math.abs(heading([0, 5, 0], null) - Math.PI / 2) < 1e-9);
  assert.ok(Math.abs(heading([5, 5, 0], 0.1) - Math.PI / 4) < 1e-9);
  assert.equal(heading([0, 0.1, 0], null), 0);
  assert.equal(heading([-1, 0, 0], 0.1), 0.1); // a run that lost itself
  assert.equal(heading([1, 1, 0], 0.1), 0.1);
  assert.equal(heading([-8, 0, 0], 0.1), 0.1);
  assert.equal(heading([null, null, null], null), 0);
});

test('the cache reads a scan once and forgets the one not used for longest', async () => {
  const reads = [];
  const cache = createScanCache(async (run, place) => { reads.push(place); return place; }, 2);
  for (const place of [0, 1, 0, 2, 0, 1]) assert.equal(await cache.get(0, place), place);
  assert.deepEqual(reads, [0, 1, 2, 1]);
});
