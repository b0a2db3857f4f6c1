// A page of the built program in the browser: the C++ writer and the viewer held against each other.
// DYNAMIC_ICP_PROGRAM names the program; skipped without it, and while its pages have no viewer.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { mkdtempSync, readFileSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import test, { after } from 'node:test';
import { pathToFileURL } from 'node:url';
import { decodeBase64, decodeMap, decodeScan, inflate } from '../src/bytes.js';
import { findBrowser, openPage, skipIfMissing } from './browser.mjs';

const FRAMES = 12;
const program = process.env.DYNAMIC_ICP_PROGRAM;
const found = program ? await findBrowser() : { missing: 'DYNAMIC_ICP_PROGRAM does not name the program' };
skipIfMissing(found);

const folder = mkdtempSync(join(tmpdir(), 'viewer-program-'));
after(() => rmSync(folder, { recursive: true, force: true }));
const drive = join(folder, 'drive');
const out = join(folder, 'run');
const quietly = { stdio: ['ignore', 'ignore', 'inherit'] };
execFileSync(program, ['simulate', 'street', '--frames', String(FRAMES), '--quiet', '--output', drive], quietly);
execFileSync(program, ['run', drive, '--output', out, '--save-labels', '--report', '--quiet'], quietly);
const file = join(out, 'report.html');
const html = readFileSync(file, 'utf8');
const held = /<script type="application\/json" id="report">([^<]*)<\/script>/.exec(html);
if (!held || !/<script>/.test(html)) {
  rmSync(folder, { recursive: true, force: true });
  skipIfMissing({ missing: 'the program was built without the viewer' });
}
const report = JSON.parse(held[1]);
const [run] = report.runs;
const scanAt = async (place) =>
  decodeScan(await inflate(decodeBase64(new RegExp(`id="scan-0-${place}">([^<]*)<`).exec(html)[1])));

test('the page holds what docs/report.md says', () => {
  assert.equal(report.schema, 1);
  assert.equal(report.kind, 'run');
  const { frames } = run;
  assert.equal(frames.index.length, FRAMES);
  assert.equal(frames.poses.length, 7 * FRAMES);
  assert.equal(frames.ego_velocity.length, 3 * FRAMES);
  for (const key of ['seconds', 'status', 'reason', 'lost_directions', 'objects']) assert.equal(frames[key].length, FRAMES, key);
  for (const plot of run.plots) for (const { name, values } of plot.series) assert.equal(values.length, FRAMES, `${plot.id} ${name}`);
  assert.ok(frames.objects.flat().length > 0 && frames.objects.flat().every((row) => row.length === 12));
  assert.equal(run.truth.poses.length, 7 * FRAMES);
  assert.deepEqual(frames.object_details.map((list) => list.length), frames.objects.map((list) => list.length));
  for (const [age, observed, faces, ...sigmas] of frames.object_details.flat()) {
    assert.ok(age >= 1 && typeof observed === 'boolean' && /^[shu]{6}$/.test(faces) && sigmas.length === 5);
    for (const sigma of sigmas) assert.ok(sigma === null || sigma >= 0);
  }
  assert.equal(run.plots.find(({ id }) => id === 'translation_error').unit, 'mm');
});

test('traces are where objects were', async () => {
  const traces = decodeMap(await inflate(decodeBase64(/id="traces-0">([^<]*)</.exec(html)[1])));
  assert.equal(traces.count, run.traces.points);
  assert.ok(traces.count > 100);
});

test('what stands has no Doppler left without the own motion, what moves has that of its object', async () => {
  for (const [place, frame] of run.scans.frames.entries()) {
    const scan = await scanAt(place);
    assert.equal(scan.count, run.scans.points[place]);
    const still = [];
    const errors = [];
    for (let i = 0; i < scan.count; ++i) {
      if (scan.compensated[i] < -1e6) continue;
      if (scan.label[i] === 1) still.push(Math.abs(scan.compensated[i]));
      if (scan.label[i] < 3) continue;
      const object = run.frames.objects[frame][scan.label[i] - 3];
      assert.ok(object, `frame ${frame}: object ${scan.label[i] - 3}`);
      const p = scan.positions.slice(3 * i, 3 * i + 3);
      const along = p[0] * object[1] + p[1] * object[2] + p[2] * object[3];
      errors.push(Math.abs(along / Math.hypot(...p) - scan.compensated[i]));
    }
    const median = (list) => list.sort((a, b) => a - b)[list.length >> 1] ?? 0;
    assert.ok(median(still) < 0.15, `frame ${frame}: ${median(still)} m/s left of what stands`);
    if (errors.length > 20) assert.ok(median(errors) < 0.5, `frame ${frame}: ${median(errors)} m/s between points and objects`);
  }
});

test('points of objects lie in their boxes', async () => {
  let inside = 0;
  let all = 0;
  for (const [place, frame] of run.scans.frames.entries()) {
    const scan = await scanAt(place);
    for (let i = 0; i < scan.count; ++i) {
      if (scan.label[i] < 3) continue;
      const [, , , , cx, cy, cz, ex, ey, ez, yaw] = run.frames.objects[frame][scan.label[i] - 3];
      const [dx, dy, dz] = [scan.positions[3 * i] - cx, scan.positions[3 * i + 1] - cy, scan.positions[3 * i + 2] - cz];
      const angle = (yaw * Math.PI) / 180;
      const along = Math.cos(angle) * dx + Math.sin(angle) * dy;
      const across = -Math.sin(angle) * dx + Math.cos(angle) * dy;
      inside += Math.abs(along) <= ex / 2 + 0.5 && Math.abs(across) <= ey / 2 + 0.5 && Math.abs(dz) <= ez / 2 + 0.5;
      ++all;
    }
  }
  assert.ok(all > 0 && inside > 0.9 * all, `${inside} of ${all}`);
});

test('the browser draws it, every frame, without an error and without the network', async () => {
  const browser = await found.launch();
  try {
    const { page, troubles } = await openPage(browser, pathToFileURL(file).href);
    for (let frame = 0; frame < FRAMES; ++frame) {
      await page.fill('input.frames', String(frame));
      await page.waitForSelector(`.scene-holder[data-frame="${frame}"]`);
    }
    assert.equal(await page.$('.failure'), null);
    assert.doesNotMatch(await page.textContent('.status-note'), /cannot/);
    assert.ok((await page.locator('canvas.scene').screenshot()).length > 20000, 'a picture with something in it');
    for (const plot of run.plots) assert.ok(await page.$(`[data-plot="${plot.id}"]`), plot.id);
    for (const tab of ['CDF', 'Summary', 'Settings']) {
      await page.click(`.tabs >> text=${tab}`);
      assert.equal(await page.evaluate(() => document.documentElement.scrollWidth), 1280);
    }
    assert.deepEqual(troubles, []);
  } finally {
    await browser.close();
  }
});
