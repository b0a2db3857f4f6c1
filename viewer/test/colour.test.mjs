import assert from 'node:assert/strict';
import test from 'node:test';
import { nextLimit, usualLimits } from '../src/colour/colourings.js';
import { lookupTable, mapColour, markColours, rgb } from '../src/colour/maps.js';

const linear = (value) => (value <= 10.31475 ? value / 3294.6 : ((value / 255 + 0.055) / 1.055) ** 2.4);
const luminance = (colour) => {
  const [r, g, b] = colour.map(linear);
  return 0.2126 * r + 0.7152 * g + 0.0722 * b;
};

/** What people without red receptors see, after Viénot, Brettel and Mollon (1999). */
function protanope(colour) {
  const [r, g, b] = colour.map(linear);
  const both = 0.11238 * r + 0.88762 * g;
  return [both, both, 0.00401 * r - 0.00401 * g + b];
}
const apart = (a, b) => Math.hypot(...protanope(a).map((value, k) => value - protanope(b)[k]));

for (const ground of ['light', 'dark']) {
  test(`${ground}: the one-sided map grows brighter all the way`, () => {
    let before = -1;
    for (let share = 0; share <= 1; share += 0.02) {
      const now = luminance(mapColour('sequential', ground, share));
      assert.ok(now > before - 1e-3, `at ${share}`);
      before = now;
    }
  });

  test(`${ground}: without red receptors both sides of the two-sided map still differ, and the middle from both`, () => {
    const at = (share) => mapColour('diverging', ground, share);
    assert.ok(apart(at(0), at(1)) > 0.2);
    assert.ok(apart(at(0), at(0.5)) > 0.15);
    assert.ok(apart(at(1), at(0.5)) > 0.15);
  });

  test(`${ground}: measured and predicted differ in brightness, not in hue alone`, () => {
    const { measured, predicted } = markColours(ground);
    assert.ok(apart(rgb(measured), rgb(predicted)) > 0.1);
  });
}

test('values outside of a map have the colour of its end', () => {
  assert.deepEqual(mapColour('diverging', 'light', -3), mapColour('diverging', 'light', 0));
  assert.deepEqual(mapColour('diverging', 'light', 7), mapColour('diverging', 'light', 1));
});

test('the table for the shader is the map', () => {
  const table = lookupTable('sequential', 'dark');
  for (const k of [0, 17, 128, 255]) assert.deepEqual([...table.slice(4 * k, 4 * k + 4)], [...mapColour('sequential', 'dark', k / 255), 255]);
});

test('limits go up and down in round steps and stop at the ends', () => {
  assert.equal(nextLimit(10, 1), 20);
  assert.equal(nextLimit(10, -1), 5);
  assert.equal(nextLimit(100, 1), 100);
  assert.equal(nextLimit(0.01, -1), 0.01);
});

test('usual limits suit the speeds of a run', () => {
  const run = { frames: { index: [0, 1, 2], ego_velocity: [13, 0, 0, null, null, null, 13.2, 0, 0], objects: [[[1, 8, 0, 0]], [[1, 0, -9, 0]], []] } };
  assert.deepEqual([usualLimits(run).doppler, usualLimits(run).compensated], [20, 10]);
});
