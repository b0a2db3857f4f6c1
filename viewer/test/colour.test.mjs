import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import test from 'node:test';
import { nextLimit, usualLimits } from '../src/colour/colourings.js';
import { CATEGORY_COUNT, categoryColour, ID_COLOURS, idColour, lookupTable, mapColour, markColours, rgb } from '../src/colour/maps.js';

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

/** What people without green receptors see. */
function deuteranope(colour) {
  const [r, g, b] = colour.map(linear);
  const both = 0.29275 * r + 0.70725 * g;
  return [both, both, -0.02234 * r + 0.02234 * g + b];
}
/** Differences in it are about as large as they look (OKLab, Ottosson 2020). @param {number[]} rgb linear */
function perceived([r, g, b]) {
  const l = Math.cbrt(0.4122214708 * r + 0.5363325363 * g + 0.0514459929 * b);
  const m = Math.cbrt(0.2119034982 * r + 0.6806995451 * g + 0.1073969566 * b);
  const s = Math.cbrt(0.0883024619 * r + 0.2817188376 * g + 0.6299787005 * b);
  return [0.2104542553 * l + 0.793617785 * m - 0.0040720468 * s, 1.9779984951 * l - 2.428592205 * m + 0.4505937099 * s,
    0.0259040371 * l + 0.7827717662 * m - 0.808675766 * s];
}
const difference = (a, b, eyes) => {
  const [p, q] = [a, b].map((hex) => perceived(eyes(rgb(hex)).map((value) => Math.max(0, value))));
  return Math.hypot(...p.map((value, k) => value - q[k]));
};
const contrast = (a, b) => {
  const [low, high] = [luminance(rgb(a)), luminance(rgb(b))].sort((p, q) => p - q);
  return (high + 0.05) / (low + 0.05);
};

for (const [ground, scene] of [['light', '#fafbfc'], ['dark', '#0c1017']]) {
  test(`${ground}: colours of ids differ from each other and from those of the legend, for any eyes, and from the ground`, () => {
    const { still, moving, selected } = markColours(ground);
    const ids = Array.from({ length: ID_COLOURS }, (_, k) => idColour(k, ground));
    ids.forEach((id, k) => {
      assert.ok(contrast(id, scene) >= 3, `${id} on ${scene}`);
      for (const other of [...ids.slice(0, k), still, moving, selected]) {
        assert.ok(difference(id, other, (colour) => colour.map(linear)) > 0.15, `${id} and ${other}`);
        for (const eyes of [protanope, deuteranope]) assert.ok(difference(id, other, eyes) > 0.085, `${id} and ${other}, ${eyes.name}`);
      }
    });
    assert.ok(contrast(markColours(ground).box, scene) >= 3 && contrast(selected, scene) >= 3);
  });

  test(`${ground}: runs have the colours of the pictures, and the style sheet the same`, () => {
    const source = readFileSync(new URL('../../dynamic_icp/tools/drawing/colour_map.cpp', import.meta.url), 'utf8');
    const list = new RegExp(`on_${ground} = \\{([^}]*)\\}`).exec(source)[1].match(/#[0-9a-f]{6}/g);
    assert.equal(list.length, CATEGORY_COUNT);
    assert.deepEqual(list.map((_, k) => categoryColour(k, ground)), list);
    const sheet = readFileSync(new URL('../src/style/base.css', import.meta.url), 'utf8').split(':root')[ground === 'light' ? 1 : 2];
    assert.deepEqual(list.map((_, k) => new RegExp(`--series-${k}: (#[0-9a-f]{6})`).exec(sheet)[1]), list);
    assert.equal(/--selected: (#[0-9a-f]{6})/.exec(sheet)[1], markColours(ground).selected);
  });
}

/** An object straight ahead. */
const ahead = (vx, vy) => [1, vx, vy, 0, 20, 0, 0, 4, 2, 1.5, 0, 10];

test('usual limits suit the speeds of a run', () => {
  const run = { frames: { index: [0, 1, 2], ego_velocity: [13, 0, 0, null, null, null, 13.2, 0, 0], objects: [[ahead(8, 0)], [ahead(0, -19)], []] } };
  const limits = usualLimits(run);
  assert.deepEqual([limits.doppler, limits.compensated], [20, 10], 'what drives across shows no Doppler');
  assert.equal(limits.arrow, 19);
});

test('a few absurd speeds do not make all others look alike', () => {
  const objects = [...Array.from({ length: 199 }, () => [ahead(9, 0)]), [ahead(1888, 0)]];
  const frames = { index: objects.map((_, k) => k), ego_velocity: objects.flatMap((_, k) => [k === 7 ? 500 : 12, 0, 0]), objects };
  const limits = usualLimits({ frames });
  assert.deepEqual([limits.compensated, limits.doppler, limits.arrow], [10, 20, 9]);
  const wrong = usualLimits({ frames: { ...frames, objects: objects.map(() => [ahead(0, 1888)]) } });
  assert.ok(wrong.arrow <= 100, 'where all are wrong arrows still end somewhere');
});
