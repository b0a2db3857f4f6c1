// The live page in a headless Chromium, served by the program itself, whose scans come one by one into a folder.
// DYNAMIC_ICP_PROGRAM names the program; skipped with 77 without it.
import assert from 'node:assert/strict';
import { execFileSync, spawn } from 'node:child_process';
import { once } from 'node:events';
import { copyFileSync, mkdirSync, mkdtempSync, readdirSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { createInterface } from 'node:readline';
import test, { after, before } from 'node:test';
import { findBrowser, skipIfMissing } from './browser.mjs';

const program = process.env.DYNAMIC_ICP_PROGRAM;
skipIfMissing({ missing: program ? null : 'DYNAMIC_ICP_PROGRAM names no program' });
const found = await findBrowser();
skipIfMissing(found);

const folder = mkdtempSync(join(tmpdir(), 'live_page-'));
const source = join(folder, 'drive', 'point_clouds');
const target = join(folder, 'growing', 'point_clouds');
const FIRST = 11; // scans that are there when the run begins
let files;
let browser;
let child;
let address;
let put = 0;

/** The sensor measures another scan. */
function measure(count = 1) {
  for (const name of files.slice(put, put + count)) copyFileSync(join(source, name), join(target, name));
  put += count;
}

before(async () => {
  execFileSync(program, ['simulate', 'city', '--output', join(folder, 'drive'), '--frames', '40', '--seed', '4', '--quiet', '--set', 'lidar.columns=400']);
  files = readdirSync(source).sort();
  mkdirSync(target, { recursive: true });
  measure(FIRST);
  child = spawn(program, ['run', join(folder, 'growing'), '--output', join(folder, 'run'), '--follow', '--live=0', '--threads', '1'], { stdio: ['ignore', 'ignore', 'pipe'] });
  for await (const line of createInterface({ input: child.stderr })) {
    address = /http:\/\/[\d.]+:\d+\//.exec(line)?.[0];
    if (address) break;
  }
  assert.ok(address, 'the address is told');
  browser = await found.launch();
});
after(async () => {
  await browser?.close();
  if (child && child.exitCode === null) {
    child.kill('SIGKILL');
    await once(child, 'exit');
  }
  rmSync(folder, { recursive: true, force: true });
});

/** A page that shows the last scan, and what went wrong on it. */
async function open(options) {
  const context = await browser.newContext({ viewport: { width: 1280, height: 800 }, ...options });
  const page = await context.newPage();
  const troubles = [];
  page.on('console', (message) => {
    if (['error', 'warning'].includes(message.type()) && !/GPU stall|software WebGL/i.test(message.text())) troubles.push(message.text());
  });
  page.on('pageerror', (error) => troubles.push(error.message));
  page.on('request', (request) => { if (!request.url().startsWith(address) && !/^(data|blob):/.test(request.url())) troubles.push(request.url()); });
  await page.goto(address);
  await page.waitForSelector('.badge[data-phase="live"]');
  return { page, troubles };
}

const draws = (page) => page.$eval('.scene-holder', (holder) => Number(holder.dataset.draws));
const drawn = (page, before_) => page.waitForFunction((count) => Number(document.querySelector('.scene-holder').dataset.draws) > count, before_);

for (const [colorScheme, width, height] of [['light', 1600, 900], ['dark', 1000, 700], ['light', 420, 800]]) {
  test(`each scan is drawn as it comes: ${colorScheme}, ${width} px`, async () => {
    const { page, troubles } = await open({ colorScheme, viewport: { width, height } });
    for (let k = 0; k < 3; ++k) {
      const count = await draws(page);
      measure();
      await drawn(page, count);
    }
    await page.waitForFunction(() => /[\d,]+ points/.test(document.querySelector('.status').textContent));
    assert.match(await page.textContent('.headline'), /speed\d/);
    assert.equal(await page.getAttribute('html', 'data-theme'), colorScheme);
    assert.equal(await page.evaluate(() => document.documentElement.scrollWidth <= window.innerWidth), true, 'nothing sticks out');
    await page.waitForSelector('[data-plot="speed"]:not([hidden])');
    await page.waitForSelector('[data-plot="latency"]:not([hidden])');
    if (process.env.LIVE_PICTURES) await page.screenshot({ path: join(process.env.LIVE_PICTURES, `live-${colorScheme}-${width}.png`) });
    assert.deepEqual(troubles, []);
    await page.context().close();
  });
}

test('colours, cameras, pause and theme by the keyboard alone', async () => {
  const { page, troubles } = await open();
  measure();
  await page.waitForFunction(() => /points/.test(document.querySelector('.status').textContent));
  const canvas = page.locator('canvas.scene');
  const usual = await canvas.screenshot();
  await page.focus('.toolbar select');
  await page.keyboard.press('ArrowDown');
  await page.waitForFunction(() => /Doppler as measured/.test(document.querySelector('.legend').textContent));
  assert.ok(!usual.equals(await canvas.screenshot()));
  for (const name of ['Top', 'Free', 'Follow']) {
    await page.getByRole('button', { name: /^Camera|^Seen/ }).nth(['Follow', 'Free', 'Top'].indexOf(name)).focus();
    await page.keyboard.press('Enter');
    await page.waitForSelector(`.segments button[aria-pressed="true"]:text-is("${name}")`);
  }
  await page.getByRole('button', { name: /^Keep the picture/ }).focus();
  await page.keyboard.press('Space');
  await page.waitForFunction(() => /Paused/.test(document.querySelector('.status').textContent));
  await page.keyboard.press('Space');
  await page.waitForFunction(() => !/Paused/.test(document.querySelector('.status').textContent));
  await page.getByRole('button', { name: 'Light or dark' }).focus();
  await page.keyboard.press('Enter');
  assert.equal(await page.getAttribute('html', 'data-theme'), 'dark');
  assert.deepEqual(troubles, []);
  await page.context().close();
});

test('a page from elsewhere cannot read the stream', async () => {
  const context = await browser.newContext();
  const page = await context.newPage();
  await page.goto('data:text/html,<title>elsewhere</title>');
  const end = await page.evaluate((where) => new Promise((done) => {
    const socket = new WebSocket(where, ['foxglove.websocket.v1']);
    socket.onmessage = () => done('read');
    socket.onerror = () => done('refused');
  }), address.replace('http', 'ws'));
  assert.equal(end, 'refused');
  await context.close();
});

test('the end of the run is told, and the results are there', async () => {
  const { page } = await open();
  child.kill('SIGINT');
  await page.waitForFunction(() => ['ended', 'lost'].includes(document.querySelector('.badge').dataset.phase));
  assert.match(await page.textContent('.status'), /has ended|no connection/);
  if (child.exitCode === null) await once(child, 'exit');
  assert.equal(child.exitCode, 130);
  assert.ok(readdirSync(join(folder, 'run')).includes('trajectory.tum'));
  await page.context().close();
});
