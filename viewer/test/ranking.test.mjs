// Rankings, worst scans and errors over distance: what they take from runs, and how they order it.
import assert from 'node:assert/strict';
import test from 'node:test';
import { linkTo, worstOf } from '../src/panels/worst_frames.js';
import { distancePlotsOf } from '../src/plots/distances.js';
import { rankingsOf } from '../src/plots/ranking.js';

const runOf = (name, colour, rte, perScan = []) => ({
  name, colour,
  summary: rte === null ? [] : [{ key: 'rte_rmse_m', number: rte }],
  plots: [{ id: 'translation_error', series: [{ name: 'error', values: perScan }] }],
});
const shownOf = (runs, places) => places.map((index) => ({ index, run: runs[index], colour: `#00000${index}`, dash: false }));

test('a ranking begins with the best and ends with what has no number', () => {
  const runs = [runOf('slow', 0, 0.05), runOf('none', 1, null), runOf('best', 2, 0.01)];
  const report = { title: 'street', runs };
  const [ranking] = rankingsOf(report, shownOf(runs, [0, 1, 2]));
  assert.deepEqual(ranking.rows.map(({ name }) => name), ['best', 'slow', 'none']);
  assert.deepEqual(ranking.rows.map(({ value }) => value), [10, 50, null]);
  assert.equal(ranking.unit, 'mm');
  assert.equal(ranking.log, false);
  assert.equal(rankingsOf(report, shownOf(runs, [1])).length, 0);
});

test('over one drive the spread is that of its scans, over several that of the drives', () => {
  const perScan = Array.from({ length: 101 }, (_, k) => k); // mm
  const runs = [runOf('icp', 0, 0.05, perScan), runOf('other', 1, 0.06), runOf('icp', 0, 0.02), runOf('icp', 0, 0.03), runOf('other', 1, 0.01)];
  const one = { title: 'a', runs, groups: [{ name: 'a', runs: [0, 1] }] };
  const [single] = rankingsOf(one, shownOf(runs, [0, 1]));
  assert.deepEqual(single.rows[0].spread, [5, 95]);
  assert.equal(single.rows[1].spread, null);
  assert.equal(single.drives, 1);

  const several = { title: 'all', runs, groups: [{ name: 'a', runs: [0, 1] }, { name: 'b', runs: [2, 4] }, { name: 'c', runs: [3] }] };
  const [ranking] = rankingsOf(several, shownOf(runs, [0, 1]));
  assert.equal(ranking.drives, 3);
  const icp = ranking.rows.find(({ name }) => name === 'icp');
  assert.deepEqual(icp.drives, [{ drive: 'a', value: 50 }, { drive: 'b', value: 20 }, { drive: 'c', value: 30 }]);
  assert.equal(icp.value, 30);
  assert.deepEqual(icp.spread, [20, 50]);
  const alone = [...runs, runOf('alone', 2, 0.04, perScan)];
  const [mixed] = rankingsOf({ ...several, runs: alone, groups: [{ name: 'a', runs: [0, 1, 5] }, ...several.groups.slice(1)] }, shownOf(alone, [0, 1, 5]));
  assert.equal(mixed.rows.find(({ name }) => name === 'alone').spread, null, 'scans of one drive are no spread over drives');
  assert.equal(ranking.rows.find(({ name }) => name === 'other').value, 35, 'the median of two is between them');
});

test('what is decades apart is ranked on a logarithmic scale, which a zero forbids', () => {
  const logOf = (...values) => {
    const runs = values.map((value, k) => runOf(String(k), k, value));
    return rankingsOf({ title: '', runs }, shownOf(runs, runs.map((_, k) => k)))[0].log;
  };
  assert.equal(logOf(0.001, 1), true);
  assert.equal(logOf(0.001, 0.003), false);
  assert.equal(logOf(0, 1), false);
});

test('the worst scans of all runs stand by their errors, those without any behind', () => {
  const frame = (scan, translation_mm) => ({ frame: scan - 100, scan, status: 'ok', translation_mm, rotation_deg: 0 });
  const runs = [{ name: 'a', worst: [frame(104, 5), frame(101, 1)] }, { name: 'b', worst: [frame(108, null)] }, { name: 'c', worst: [frame(102, 3)] }, { name: 'd' }];
  assert.deepEqual(worstOf(shownOf(runs, [0, 1, 2, 3])).map(({ scan }) => scan), [104, 102, 101, 108]);
});

test('links to pages of runs survive any name of a folder', () => {
  assert.equal(linkTo('../a b/run#2/100%?/report.html', 7), '../a%20b/run%232/100%25%3F/report.html#frame=7');
  assert.ok(!linkTo('javascript:alert(1)', 0).startsWith('javascript:'), 'no name becomes a program');
});

test('errors over distance: the drift of each run that has one, and errors over stretches', () => {
  const run = {
    name: 'a', frames: { distance: [0, 1, 2] }, plots: [{ id: 'position_error', series: [{ name: 'error', values: [0, 0.1, 0.3] }] }],
    stretches: { length: [1, 2], count: [2, 1], translation: [10, 15], rotation: [0.5, 0.25] },
  };
  const bare = { name: 'b', frames: { distance: [0, 9, 18] }, plots: [], stretches: null };
  const plots = distancePlotsOf(shownOf([run, bare], [0, 1]));
  assert.deepEqual(plots.map(({ id }) => id), ['drift', 'stretch_translation', 'stretch_rotation']);
  for (const { series } of plots) assert.deepEqual(series.map(({ name }) => name), ['a']);
  assert.deepEqual([plots[0].x.low, plots[0].x.high], [0, 2]);
  assert.deepEqual(plots[1].series[0].ys, [10, 15]);
  assert.deepEqual([plots[1].x.low, plots[1].x.high, plots[1].x.log], [1, 2, true]);
  assert.deepEqual(distancePlotsOf(shownOf([bare], [0])), []);
});
