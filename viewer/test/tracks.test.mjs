import assert from 'node:assert/strict';
import test from 'node:test';
import { statusCounts } from '../src/panels/headline.js';
import { byMeasure } from '../src/panels/summary.js';
import { detailsOf, headingInWorld, nearestOf, objectAt, speedPlotOf, summaryOf, tracksOf } from '../src/tracks.js';

/** Turned by 90 degrees about z: the sensor's x axis is the world's y axis. */
const LEFT = [0, 0, 0, 0, 0, Math.SQRT1_2, Math.SQRT1_2];
const row = (id, vx, vy, x = 10) => [id, vx, vy, 0, x, 0, 0, 4, 2, 1.5, 0, 50];

const run = {
  frames: {
    index: [0, 1, 2, 3, 4], seconds: [0, 0.1, 0.2, 0.3, 0.4], poses: [...LEFT, ...LEFT, ...Array(7).fill(null), ...LEFT, ...LEFT],
    objects: [[row(5, 3, 0)], [row(8, 0, 1), row(5, 4, 0, 6)], [], [row(5, 0, 8)], []],
    object_details: [[[1, false, 'suuusu', 0.5, 3, 0.1, 0.5, 0.2]], [null, [2, true, 'sshuss', 0.3, 2, 0.1, 0.3, 0.1]], [], [[4, true, 'sshuss', 0.4, 2, 0.1, 0.3, null]], []],
  },
};

test('tracks are the ids through all frames, wherever they stand in the lists', () => {
  const tracks = tracksOf(run);
  assert.deepEqual([...tracks.keys()], [5, 8]);
  assert.deepEqual(tracks.get(5), { id: 5, frames: [0, 1, 3], places: [0, 1, 0] });
  assert.equal(nearestOf(run, tracks.get(5), 4).frame, 3);
  assert.equal(nearestOf(run, tracks.get(8), 0).speed, 1);
});

test('what is stated of an object is that of its place in the list', () => {
  const { age, observed, faces, speedSigma } = detailsOf(run, 1, 1);
  assert.deepEqual([age, observed, speedSigma], [2, true, 0.3]);
  assert.deepEqual(faces.map(({ face, view }) => `${face} ${view}`),
    ['front seen', 'rear seen', 'left hidden', 'right unknown', 'top seen', 'bottom seen']);
  assert.equal(detailsOf(run, 1, 0), null);
  assert.equal(detailsOf({ frames: { objects: [[row(1, 1, 1)]] } }, 0, 0), null, 'pages that hold none');
});

test('headings are those in the world, of what moves', () => {
  const heading = (frame, place) => headingInWorld(run, frame, objectAt(run, frame, place));
  assert.ok(Math.abs(heading(0, 0) - 90) < 1e-9, 'ahead of a sensor that looks along y');
  assert.ok(Math.abs(heading(1, 0) - 180) < 1e-9, 'to the left of it');
  assert.equal(headingInWorld(run, 0, { velocity: [0.1, 0, 0] }), null);
  assert.equal(headingInWorld(run, 2, { velocity: [9, 0, 0] }), null, 'no pose');
});

test('a track in a line', () => {
  const summary = summaryOf(run, tracksOf(run).get(5));
  assert.equal(summary.scans, 3);
  assert.deepEqual([summary.from, summary.to, summary.speed, summary.speedSigma, summary.range], [0, 3, 4, 0.4, 6]);
  assert.ok(Math.abs(summary.observed - 2 / 3) < 1e-9);
  assert.equal(summary.facesSeen, 4);
  assert.equal(summaryOf(run, tracksOf(run).get(8)).observed, null);
});

test('the plot of a speed has a gap where the track has one', () => {
  const [series] = speedPlotOf(run, tracksOf(run).get(5)).series;
  assert.deepEqual(series.xs, [0, 0.1, 0.2, 0.3]);
  assert.deepEqual(series.ys, [3, 4, null, 8]);
  assert.deepEqual(series.sigma, [0.5, 0.3, null, 0.4]);
});

test('statuses are counted; the first scan is none of them', () => {
  assert.deepEqual([...statusCounts(['first', 'ok', 'ok', 'lost', 'skipped'])], [['ok', 3], ['degenerate', 0], ['lost', 1], ['skipped', 1]]);
});

test('statistics of one measure stand in one row; what belongs to none is kept', () => {
  const entry = (key) => ({ key, value: key });
  const { rows, rest } = byMeasure(['frames', 'rte_mean_m', 'rte_rmse_m', 'ms_p95', 'path_length_m'].map(entry));
  assert.deepEqual(rows.map(({ name, cells }) => [name, ...cells.map((cell) => cell?.key)]), [
    ['RTE', 'rte_rmse_m', 'rte_mean_m', undefined, undefined], ['time per scan', undefined, undefined, undefined, 'ms_p95']]);
  assert.deepEqual(rest.map(({ key }) => key), ['frames', 'path_length_m']);
});
