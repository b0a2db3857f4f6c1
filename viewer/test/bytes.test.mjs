import assert from 'node:assert/strict';
import { deflateSync } from 'node:zlib';
import test from 'node:test';
import { decodeBase64, decodeMap, decodeScan, inflate, UNKNOWN } from '../src/bytes.js';
import { mapBytes, randomSource, scanBytes } from './sample_page.mjs';

const buffer = (bytes) => bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.byteLength);

test('a scan written byte by byte reads as what was meant', () => {
  // Two points, unit 0.5 m: (1, -2, 3) and (2, -2, 0.5); by hand from docs/report.md.
  const bytes = Uint8Array.from([
    2, 0, 0, 0, 0, 0, 0, 0x3f, // n, 0.5f
    2, 0, 2, 0, // x: 2, then +2
    0xfc, 0xff, 0, 0, // y: -4, then 0
    6, 0, 0xfb, 0xff, // z: 6, then -5
    0x9c, 0xff, 0x2c, 1, // Doppler: -100, 300 -> -1 and 3 m/s
    0, 0x80, 50, 0, // compensated: unknown, 0.5 m/s
    1, 4, // static, second object
    255, 3, // no surface, 15 mm
  ]);
  const scan = decodeScan(buffer(bytes));
  assert.equal(scan.count, 2);
  assert.deepEqual([...scan.positions], [1, -2, 3, 2, -2, 0.5]);
  assert.deepEqual([...scan.doppler], [-1, 3]);
  assert.deepEqual([...scan.compensated], [Math.fround(UNKNOWN), 0.5]);
  assert.deepEqual([...scan.label], [1, 4]);
  assert.equal(scan.residual[0], Math.fround(UNKNOWN));
  assert.ok(Math.abs(scan.residual[1] - 0.015) < 1e-7);
});

test('differences wrap around 2^16: far points in any order come back', () => {
  const random = randomSource(5);
  const unit = 0.01;
  const points = Array.from({ length: 501 }, () => ({
    x: 600 * random() - 300, y: 600 * random() - 300, z: 60 * random() - 30, doppler: 80 * random() - 40,
    compensated: random() < 0.2 ? null : 20 * random() - 10, label: Math.floor(9 * random()), residual: random() < 0.2 ? null : 1.2 * random(),
  }));
  const scan = decodeScan(buffer(scanBytes(points, unit)));
  points.forEach((point, i) => {
    ['x', 'y', 'z'].forEach((axis, k) => assert.ok(Math.abs(scan.positions[3 * i + k] - point[axis]) <= 0.501 * unit));
    assert.ok(Math.abs(scan.doppler[i] - point.doppler) <= 0.00501);
    if (point.compensated === null) assert.ok(scan.compensated[i] < -1e8);
    else assert.ok(Math.abs(scan.compensated[i] - point.compensated) <= 0.00501);
    assert.equal(scan.label[i], point.label);
    if (point.residual === null) assert.ok(scan.residual[i] < -1e8);
    else assert.ok(Math.abs(scan.residual[i] - point.residual) <= 0.00251);
  });
});

test('a map keeps its origin in full and its points after it', () => {
  const origin = [482000.123456789, 5514000.987654321, -300.5];
  const points = [[0, 0, 0], [2000.5, -1500.25, 12], [-3000, 4000, -7]].map((p) => p.map((v, k) => v + origin[k]));
  const map = decodeMap(buffer(mapBytes(points, 0.01, origin)));
  assert.deepEqual(map.origin, origin);
  points.forEach((point, i) => point.forEach((value, k) =>
    assert.ok(Math.abs(map.positions[3 * i + k] - (value - origin[k])) <= 0.0051)));
});

test('an empty scan is a scan; one cut short is not', () => {
  assert.equal(decodeScan(buffer(scanBytes([], 0.01))).count, 0);
  const whole = scanBytes([{ x: 1, y: 1, z: 1, doppler: 0, compensated: 0, label: 1, residual: 0 }], 0.01);
  assert.throws(() => decodeScan(buffer(whole.subarray(0, whole.length - 1))), /1 points has 19 bytes, not 20/);
  assert.throws(() => decodeScan(new ArrayBuffer(3)));
  assert.throws(() => decodeMap(new ArrayBuffer(31)));
});

test('base64 and zlib are undone; damaged data fail', async () => {
  const bytes = Buffer.from(Array.from({ length: 5000 }, (_, i) => (i * i) % 251));
  const text = deflateSync(bytes).toString('base64');
  assert.deepEqual(Buffer.from(await inflate(decodeBase64(` ${text}\n`))), bytes);
  await assert.rejects(inflate(decodeBase64(text).subarray(0, 40)));
  await assert.rejects(inflate(Uint8Array.from([1, 2, 3, 4])));
});
