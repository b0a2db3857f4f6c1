import assert from 'node:assert/strict';
import test from 'node:test';
import { fitState, sameScan } from '../src/session.js';
import { readFragment, writeFragment } from '../src/state.js';

const usual = {
  group: 0, run: 0, frame: 0, colour: 'compensated', limit: null, layers: new Set(['boxes', 'ids']), camera: 'follow',
  eye: null, size: 2.5, speed: 1, tab: 'plots', hidden: new Set(), theme: null,
  object: null, chase: false, zoom: null, folded: new Set(),
};

test('what is written is read again', () => {
  const state = {
    ...usual, group: 2, run: 5, frame: 77, colour: 'residual', limit: 0.05, layers: new Set(['map']), camera: 'free',
    eye: [1.25, -2, 3, 4, 5.5, -6.75], size: 4, speed: 0.25, tab: 'summary', hidden: new Set([3, 4]), theme: 'dark',
    object: 12, chase: true, zoom: [1.5, 7.25], folded: new Set(['ego_speed', 'fitness']),
  };
  assert.deepEqual({ ...usual, ...readFragment(`#${writeFragment(state, usual)}`) }, state);
});

test('what is usual is left out, but the frame', () => {
  assert.equal(writeFragment({ ...usual, frame: 9 }, usual), 'frame=9');
});

test('an empty set of layers is a state of its own', () => {
  const text = writeFragment({ ...usual, layers: new Set() }, usual);
  assert.deepEqual(readFragment(text).layers, new Set());
});

test('nonsense in a link is left out', () => {
  assert.deepEqual(readFragment('#frame=-3&colour=<b>&eye=1,2&size=NaN&camera=free&__proto__=1&toString=2&limit=&run=1e9'), { camera: 'free' });
  assert.deepEqual(readFragment('#layers=boxes,<script>,ids').layers, new Set(['boxes', 'ids']));
});

test('what no control of the page can show falls back to what is usual', () => {
  assert.deepEqual(readFragment('#colour=zzz&camera=quark&layers=,,&limit=-4'), {});
  assert.deepEqual(readFragment('#layers=quark&limit=0&size=0.1&speed=3&theme=pink&colour=toString&eye=,,,,,'), {});
  assert.deepEqual(readFragment('#limit=1e9&size=400&speed=-1&eye=1e300,0,0,0,0,0&layers=quark,map&theme=dark'),
    { layers: new Set(['map']), theme: 'dark' });
  assert.deepEqual(readFragment('#zoom=3,1&object=-4&chase=yes&folded=<b>'), { folded: new Set() });
  assert.deepEqual(readFragment('#zoom=1&object=x'), {});
  assert.deepEqual(readFragment('#limit=0.01&size=8&speed=0.1'), { limit: 0.01, size: 8, speed: 0.1 });
});

const run = (frames, scans = null) => ({
  frames: { index: Array.from({ length: frames }, (_, k) => 10 + 2 * k), objects: [[[7]], [[8], [9]]] }, scans,
});
const report = { runs: [run(5), run(9, {}), run(3)], groups: [{ name: 'a', runs: [0, 1] }, { name: 'b', runs: [2] }] };

test('a link to what this page has not falls back to what it has', () => {
  assert.equal(fitState(report, { ...usual, frame: 400, run: 1 }).frame, 8);
  const other = fitState(report, { ...usual, group: 1, run: 0, frame: 4 });
  assert.deepEqual([other.group, other.run, other.frame], [1, 2, 2]);
  assert.deepEqual([fitState(report, { ...usual, group: 7, run: 77 }).group, fitState(report, { ...usual, run: 77 }).run], [0, 1]);
});

test('an object that the run has not is not selected, nor followed', () => {
  const fit = (object) => { const { object: id, chase } = fitState(report, { ...usual, object, chase: true }); return [id, chase]; };
  assert.deepEqual([fit(9), fit(10), fit(null)], [[9, true], [null, false], [null, false]]);
});

test('another run is shown at the same scan', () => {
  const every = { frames: { index: [0, 1, 2, 3, 4, 5, 6, 7] } };
  const second = { frames: { index: [1, 3, 5] } };
  assert.deepEqual([0, 1, 2, 3, 7].map((frame) => sameScan(every, frame, second)), [0, 0, 0, 1, 2]);
  assert.deepEqual([0, 1, 2].map((frame) => sameScan(second, frame, every)), [1, 3, 5]);
});
