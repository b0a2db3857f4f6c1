import assert from 'node:assert/strict';
import test from 'node:test';
import { bestOf } from '../src/panels/comparison.js';
import { cumulative } from '../src/plots/distributions.js';
import { tracePolyline } from '../src/plots/polyline.js';
import { needsLogarithm } from '../src/plots/time_plots.js';
import { createScale, labelBeside, roundStep, tickText, valueRange } from '../src/plots/scale.js';

test('steps are 1, 2 or 5 times a power of ten', () => {
  assert.deepEqual([roundStep(10, 5), roundStep(7, 5), roundStep(0.13, 4), roundStep(1000, 3)], [2, 2, 0.05, 500]);
});

test('a scale goes there and back, linear and logarithmic', () => {
  for (const log of [false, true]) {
    const scale = createScale({ low: 0.001, high: 10, from: 40, to: 300, log });
    assert.equal(Math.round(scale.place(0.001)), 40);
    assert.equal(Math.round(scale.place(10)), 300);
    for (const value of [0.002, 0.5, 7]) assert.ok(Math.abs(scale.value(scale.place(value)) / value - 1) < 1e-9);
  }
  assert.equal(createScale({ low: 0.01, high: 1, from: 0, to: 10, log: true }).place(0), 0);
});

test('ticks lie within the range, are few, and their texts differ', () => {
  const ranges = [[0, 1], [11.99, 12.01], [-3, 250], [0.004, 0.13, true], [0.0021, 0.0029, true], [1e-6, 10, true], [0, 1e5]];
  for (const [low, high, log] of ranges) {
    for (const most of [2, 3, 6]) {
      const ticks = createScale({ low, high, from: 0, to: 100, log }).ticks(most);
      assert.ok(ticks.length >= 1 && ticks.length <= most + 1, `${low} to ${high}: ${ticks}`);
      for (const tick of ticks) assert.ok(tick >= low * 0.999 - 1e-9 && tick <= high * 1.001 + 1e-9);
      const texts = ticks.map((tick) => tickText(tick, ticks));
      assert.equal(new Set(texts).size, texts.length, `${texts}`);
    }
  }
});

test('counts have no ticks in between', () => {
  const ticks = createScale({ low: 0, high: 2.1, from: 0, to: 100, whole: true }).ticks(6);
  assert.deepEqual(ticks, [0, 1, 2]);
});

test('ranges hold all values, leave out what does not exist, and begin at zero when they must', () => {
  const range = valueRange([[1, null, 3], [NaN, 2]]);
  assert.ok(range.low < 1 && range.low > 0.8 && range.high > 3);
  assert.equal(valueRange([[1, 3]], { fromZero: true }).low, 0);
  assert.ok(valueRange([[0, -1, 0.01, 1]], { log: true }).low > 0);
  assert.deepEqual(valueRange([[null]]), { low: 0, high: 1 });
});

const trace = (xs, ys) => {
  const calls = [];
  tracePolyline(xs, ys, { move: (x, y) => calls.push(['move', y]), line: (x, y) => calls.push(['line', y]), dot: (x, y) => calls.push(['dot', y]) });
  return calls;
};

test('the name of a level lies within the picture, wherever the level does', () => {
  const letters = 13;
  for (let line = 6; line <= 120; ++line) {
    const { y, baseline } = labelBeside(line, letters);
    const [top, bottom] = baseline === 'bottom' ? [y - letters, y] : [y, y + letters];
    assert.ok(top >= 0, `${line}: from ${top}`);
    assert.ok(bottom < line || top > line, `${line}: from ${top} to ${bottom}`);
    assert.equal(baseline, line >= 15 ? 'bottom' : 'top', 'above its line where there is room');
  }
});

test('a line breaks where values are missing, and a lone value is a dot', () => {
  const calls = trace([0, 10, 20, 30, 40], [1, 2, null, 4, null]);
  assert.equal(calls.filter(([what]) => what === 'move').length, 2);
  assert.deepEqual(calls.filter(([what]) => what === 'dot'), [['dot', 4]]);
});

test('many values in one column of pixels keep their extremes', () => {
  const count = 10000;
  const xs = Array.from({ length: count }, (_, k) => (100 * k) / count);
  const ys = xs.map((_, k) => (k === 3337 ? 99 : k === 7771 ? -99 : Math.sin(k)));
  const calls = trace(xs, ys);
  assert.ok(calls.length <= 4 * 100 + 4);
  assert.ok(calls.some(([, y]) => y === 99) && calls.some(([, y]) => y === -99));
});

test('the cumulative curve gives the share up to a value', () => {
  const { xs, ys } = cumulative([4, null, 1, 2, 2]);
  assert.deepEqual(xs, [1, 1, 2, 2, 2, 2, 4, 4]);
  assert.deepEqual(ys, [0, 25, 25, 50, 50, 75, 75, 100]);
  const values = Array.from({ length: 5000 }, (_, k) => (k * 7919) % 5000);
  const long = cumulative(values);
  long.xs.forEach((x, k) => { if (k % 2) assert.ok(Math.abs(long.ys[k] - (100 * values.filter((value) => value <= x).length) / 5000) < 1e-9); });
});

test('runs that differ by far get a logarithmic axis, runs alike do not', () => {
  assert.ok(needsLogarithm([[0.0005, 0.0006, null], [0.03, 0.2, 0.04]]));
  assert.ok(!needsLogarithm([[5, 6], [7, 9, 8]]));
  assert.ok(!needsLogarithm([[0, 0, 0], [4, 5, 6]]));
  assert.ok(!needsLogarithm([[1, 2], [null]]));
});

test('the best is marked only where there is a choice', () => {
  assert.deepEqual(bestOf([2, 1, null], 'lower'), [false, true, false]);
  assert.deepEqual(bestOf([2, 1, 2], 'higher'), [true, false, true]);
  assert.deepEqual(bestOf([2, 1], null), [false, false]);
  assert.deepEqual(bestOf([1, 1], 'lower'), [false, false]);
  assert.deepEqual(bestOf([1, null], 'lower'), [false, false]);
});
