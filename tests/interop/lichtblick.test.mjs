// What run --mcap writes and what run --live sends, with the layout that is written beside the file, in Lichtblick in a headless Chromium.
// Status 77 (skipped) without the browser or without a built Lichtblick, which DYNAMIC_ICP_LICHTBLICK names. DYNAMIC_ICP_PROGRAM names the
// program; LICHTBLICK_PICTURES a folder for the pictures.
import assert from 'node:assert/strict';
import { execFileSync, spawn } from 'node:child_process';
import { once } from 'node:events';
import fs from 'node:fs';
import http from 'node:http';
import os from 'node:os';
import path from 'node:path';
import { createInterface } from 'node:readline';

import { findBrowser, skipIfMissing } from '../../viewer/test/browser.mjs';

const app = process.env.DYNAMIC_ICP_LICHTBLICK;
const howToGetIt =
  'DYNAMIC_ICP_LICHTBLICK names no built Lichtblick: in a checkout of github.com/lichtblick-suite/lichtblick run ' +
  '`yarn install` and `yarn run web:build:prod`, and name its folder web/.webpack';
skipIfMissing({ missing: app && fs.existsSync(path.join(app, 'index.html')) ? null : howToGetIt });
const found = await findBrowser();
skipIfMissing(found);

const SCANS = 40; // in the last one a vehicle comes closer and one goes away
const FIRST = 11; // scans that are there when the live run begins
const PATIENCE_MS = 60_000;
const TOPICS = ['/ground_truth/path', '/objects', '/odometry/state', '/path', '/points', '/tf'];
const TITLES = ['Speed (m/s)', 'Standard deviations of the ego velocity (m/s)', 'Position: deviations of a step, error (m)'];
const TYPES = { '.html': 'text/html', '.js': 'text/javascript', '.wasm': 'application/wasm', '.json': 'application/json', '.css': 'text/css' };

const program = process.env.DYNAMIC_ICP_PROGRAM;
const folder = fs.mkdtempSync(path.join(os.tmpdir(), 'lichtblick-'));
const at = (...names) => path.join(folder, ...names);
const lines = (...names) => fs.readFileSync(at(...names), 'utf8').trim().split('\n').map((line) => JSON.parse(line));
const speedOf = (frame) => Math.hypot(...frame.ego_velocity);

/// Files of the app and of the test, whole or in part, as recordings are read.
function serve(request, response) {
  const { pathname } = new URL(request.url, 'http://localhost');
  const name = path.normalize(decodeURIComponent(pathname === '/' ? '/index.html' : pathname));
  const file = [app, folder].map((root) => path.join(root, name)).find((one) => fs.statSync(one, { throwIfNoEntry: false })?.isFile());
  if (!file) {
    response.writeHead(404).end();
    return;
  }
  const size = fs.statSync(file).size;
  const range = /^bytes=(\d+)-(\d*)$/.exec(request.headers.range ?? '');
  const start = range ? Number(range[1]) : 0;
  const end = range?.[2] ? Math.min(Number(range[2]), size - 1) : size - 1;
  response.writeHead(range ? 206 : 200, {
    'content-type': TYPES[path.extname(file)] ?? 'application/octet-stream',
    'content-length': end - start + 1,
    'accept-ranges': 'bytes',
    ...(range ? { 'content-range': `bytes ${start}-${end}/${size}` } : {}),
  });
  if (request.method === 'HEAD') response.end();
  else fs.createReadStream(file, { start, end }).on('error', () => response.destroy()).pipe(response);
}

/// Lichtblick with a source of data and our layout, and what goes wrong in it.
async function open(browser, origin, source) {
  const context = await browser.newContext({ viewport: { width: 1600, height: 1000 }, colorScheme: 'dark' });
  const page = await context.newPage();
  const troubles = [];
  page.on('pageerror', (error) => troubles.push(error.message));
  page.on('console', (message) => {
    // The last one is what a player says whose clock does not fit the messages.
    if (message.type() === 'error' || /receiveTime very different/.test(message.text())) troubles.push(message.text());
  });
  await page.goto(`${origin}/?${new URLSearchParams({ ...source, layoutUrl: `${origin}/foxglove_layout.json` })}`);
  return { context, page, troubles };
}

/// The value behind a name in a legend; NaN: none.
async function legend(page, name) {
  const text = await page.evaluate(() => document.body.innerText);
  return Number(new RegExp(`^${name}\\n([-\\d.e]+)$`, 'm').exec(text)?.[1] ?? NaN);
}

async function until(what, holds) {
  for (const begin = Date.now(); Date.now() - begin < PATIENCE_MS; await new Promise((done) => setTimeout(done, 100))) {
    if (await holds()) return;
  }
  assert.fail(`in vain: ${what}`);
}

/// The 3D panel alone, and how many of its pixels look like what.
async function countPixels(page) {
  const canvas = page.locator('canvas').first();
  const png = await canvas.screenshot({ style: 'body * { visibility: hidden !important } canvas { visibility: visible !important }' });
  return page.evaluate(async (base64) => {
    const bytes = Uint8Array.from(atob(base64), (letter) => letter.charCodeAt(0));
    const picture = await createImageBitmap(new Blob([bytes], { type: 'image/png' }));
    const pen = new OffscreenCanvas(picture.width, picture.height).getContext('2d');
    pen.drawImage(picture, 0, 0);
    const { data } = pen.getImageData(0, 0, picture.width, picture.height);
    const counts = { all: data.length / 4, background: 0, standing: 0, closer: 0, away: 0, path: 0, marks: 0 };
    for (let k = 0; k < data.length; k += 4) {
      const [r, g, b] = data.slice(k, k + 3);
      const spread = Math.max(r, g, b) - Math.min(r, g, b);
      if (Math.abs(r - 16) + Math.abs(g - 20) + Math.abs(b - 24) < 12) ++counts.background;
      else if (spread < 12 && g > 235) ++counts.marks; // boxes, arrows and their texts
      else if (spread < 24 && g > 160 && g < 215) ++counts.standing;
      else if (b > 200 && r < 120 && g > 150) ++counts.closer;
      else if (r > 200 && b < 120 && g > 130) ++counts.away;
      else if (g - r > 45 && g > b && b > 90) ++counts.path;
    }
    return counts;
  }, png.toString('base64'));
}

/// Points by their Doppler, boxes and the path: none of them is a few pixels only.
async function checkScene(page) {
  await until('a scene with points, objects and the path', async () => {
    const counts = await countPixels(page);
    return counts.standing > 5000 && Math.min(counts.closer, counts.away, counts.path, counts.marks) > 100 && counts.background > counts.all / 4;
  }).catch(async (error) => assert.fail(`${error.message} ${JSON.stringify(await countPixels(page))}`));
}

async function checkSidebar(page, topics) {
  await page.getByRole('tab', { name: /^Topics/ }).click();
  await page.getByTestId('topic-row').first().waitFor();
  const rows = await page.getByTestId('topic-row').allInnerTexts();
  assert.deepEqual(rows.map((row) => row.split('\n').find((line) => line.startsWith('/'))), topics);
  await page.getByRole('tab', { name: /^Alerts/ }).click();
  await page.getByText('No alerts found').waitFor({ timeout: PATIENCE_MS });
  const text = await page.evaluate(() => document.body.innerText);
  for (const title of [...TITLES, 'status', 'reason']) assert.ok(text.includes(title), title);
}

async function takePicture(page, name) {
  const pictures = process.env.LICHTBLICK_PICTURES;
  if (!pictures) return;
  await page.getByRole('tab', { name: /^Topics/ }).click();
  await page.waitForTimeout(3000); // all is drawn
  await page.screenshot({ path: path.join(pictures, name) });
}

async function opensTheFile(browser, origin) {
  const frames = lines('run', 'frames.jsonl');
  assert.equal(frames.length, SCANS);
  const [stamp] = fs.readFileSync(at('run', 'trajectory.tum'), 'utf8').trim().split('\n').at(-1).split(' ');
  const time = new Date(Math.round(Number(stamp) * 1000)).toISOString();
  const { context, page, troubles } = await open(browser, origin, { ds: 'remote-file', 'ds.url': `${origin}/run.mcap`, time });
  await until('the speed of the last scan', async () => Math.abs((await legend(page, 'speed')) - speedOf(frames.at(-1))) < 1e-9);
  assert.ok(Math.abs((await legend(page, 'forward')) - frames.at(-1).ego_velocity[0]) < 1e-9);
  assert.ok((await legend(page, 'error')) < 0.1, 'the ground truth is near');
  await takePicture(page, 'mcap.png');
  await checkScene(page);
  await checkSidebar(page, TOPICS);
  assert.deepEqual(troubles, []);
  await context.close();
}

async function watchesTheRun(browser, origin) {
  const source = at('drive', 'point_clouds');
  const target = at('growing', 'point_clouds');
  fs.mkdirSync(target, { recursive: true });
  const names = fs.readdirSync(source).sort();
  const measure = (from, to) => names.slice(from, to).forEach((name) => fs.copyFileSync(path.join(source, name), path.join(target, name)));
  measure(0, FIRST);
  const words = ['run', at('growing'), '--output', at('watched'), '--follow', '--live=0', '--live-origin', origin];
  const child = spawn(program, words, { stdio: ['ignore', 'ignore', 'pipe'] });
  try {
    let authority;
    for await (const line of createInterface({ input: child.stderr })) {
      authority = /ws:\/\/([\d.]+:\d+)/.exec(line)?.[1];
      if (authority) break;
    }
    const { context, page, troubles } = await open(browser, origin, { ds: 'foxglove-websocket', 'ds.url': `ws://${authority}` });
    await until('the scans that are there', async () => (await legend(page, 'speed')) > 0);
    for (let k = FIRST; k < names.length; ++k) {
      const before = await legend(page, 'speed');
      measure(k, k + 1);
      await until(`scan ${k}, which is late until the next one is there`, async () => (await legend(page, 'speed')) !== before);
    }
    await takePicture(page, 'live.png');
    await checkScene(page);
    await checkSidebar(page, TOPICS.filter((topic) => topic !== '/ground_truth/path'));
    assert.deepEqual(troubles, []);
    const speed = await legend(page, 'speed');
    await context.close();
    child.kill('SIGINT');
    if (child.exitCode === null) await once(child, 'exit');
    const frames = lines('watched', 'frames.jsonl');
    assert.equal(frames.length, SCANS);
    assert.ok(Math.abs(speed - speedOf(frames.at(-1))) < 1e-9, `${speed}, expected ${speedOf(frames.at(-1))}`);
  } finally {
    child.kill('SIGKILL');
  }
}

const server = http.createServer(serve);
let browser;
try {
  execFileSync(program, ['simulate', 'city', '--output', at('drive'), '--frames', String(SCANS), '--seed', '4', '--quiet']);
  execFileSync(program, ['run', at('drive'), '--output', at('run'), '--mcap', at('run.mcap'), '--quiet']);
  await new Promise((done) => server.listen(0, '127.0.0.1', done));
  const origin = `http://127.0.0.1:${server.address().port}`;
  browser = await found.launch();
  await opensTheFile(browser, origin);
  await watchesTheRun(browser, origin);
} finally {
  await browser?.close();
  server.close();
  fs.rmSync(folder, { recursive: true });
}
console.log('passed');
