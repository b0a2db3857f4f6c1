// How fast pages are, with software rendering: time until the first picture of a scan, pictures a second while scrubbing and
// turning, and what of each is time of the page itself: its thread, and of that its scripts. The rest is drawing by the processor.
//   node test/measure.mjs PAGE.html ...                   pages that are there, one after the other in each round: compared
//                                                         while the same other things go on
//   node test/measure.mjs [--frames 1000] [--points 3500] a page of an invented drive
//   [--rounds N]                                          medians of so many; 3 where pages are compared
import { mkdtempSync, rmSync, statSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { basename, join, resolve } from 'node:path';
import { pathToFileURL } from 'node:url';
import { bundle } from '../build.mjs';
import { findBrowser } from './browser.mjs';
import { pageOf, sampleRun } from './sample_page.mjs';

const args = process.argv.slice(2);
const option = (name, usual) => (args.includes(name) ? Number(args[args.indexOf(name) + 1]) : usual);
const folder = mkdtempSync(join(tmpdir(), 'viewer-measure-'));
const files = args.filter((argument) => argument.endsWith('.html')).map((file) => resolve(file));
if (files.length === 0) {
  const [frames, points] = [option('--frames', 1000), option('--points', 3500)];
  files.push(join(folder, 'page.html'));
  writeFileSync(files[0], pageOf({ kind: 'run', title: `${frames} frames of ${points} points`, parts: [sampleRun({ frames, points, unit: 0.02 })] }, await bundle()));
}

/** Remembers when the first scan was drawn: in ms after the page was asked for. */
function watchFirst() {
  const watcher = new MutationObserver(() => {
    if (!(Number(document.querySelector('.scene-holder')?.dataset.frame) > 0)) return; // frame 0 is drawn before any scan is there
    window.firstPicture = performance.now();
    watcher.disconnect();
  });
  watcher.observe(document, { subtree: true, attributes: true, attributeFilter: ['data-draws'] });
}

/** Moves the slider at every picture the browser shows, in jumps, so that nothing is decoded before. */
async function scrub() {
  const holder = document.querySelector('.scene-holder');
  const slider = document.querySelector('input.frames');
  const before = Number(holder.dataset.draws);
  const start = performance.now();
  for (let k = 0; performance.now() - start < 4000; ++k) {
    slider.value = String((37 * k) % (Number(slider.max) + 1));
    slider.dispatchEvent(new Event('input', { bubbles: true }));
    await new Promise(requestAnimationFrame);
  }
  return { draws: Number(holder.dataset.draws) - before, seconds: (performance.now() - start) / 1000 };
}

async function turn() {
  const holder = document.querySelector('.scene-holder');
  const canvas = document.querySelector('canvas.scene');
  const before = Number(holder.dataset.draws);
  const send = (type, x) => canvas.dispatchEvent(new PointerEvent(type, { clientX: x, clientY: 300, button: 0, buttons: 1, pointerId: 1, pointerType: 'mouse', bubbles: true }));
  canvas.setPointerCapture = () => {};
  canvas.releasePointerCapture = () => {};
  const start = performance.now();
  send('pointerdown', 200);
  for (let x = 200; performance.now() - start < 3000; x += 3) {
    send('pointermove', x);
    await new Promise(requestAnimationFrame);
  }
  send('pointerup', 400);
  return { draws: Number(holder.dataset.draws) - before, seconds: (performance.now() - start) / 1000 };
}

async function measure(found, file) {
  const browser = await found.launch();
  try {
    const context = await browser.newContext({ viewport: { width: 1280, height: 800 } });
    const page = await context.newPage();
    await page.goto('about:blank');
    await page.evaluate(() => document.createElement('canvas').getContext('webgl2')?.finish()); // the browser itself has begun
    await page.addInitScript(watchFirst);
    const session = await context.newCDPSession(page);
    await session.send('Performance.enable', { timeDomain: 'threadTicks' }); // time of the thread, whatever else the machine does
    const spent = async () => {
      const { metrics } = await session.send('Performance.getMetrics');
      const of = (wanted) => 1000 * metrics.find(({ name }) => name === wanted).value;
      return { thread: of('TaskDuration'), scripts: of('ScriptDuration') };
    };
    await page.goto(pathToFileURL(file).href, { waitUntil: 'commit' });
    await page.waitForFunction(() => window.firstPicture && document.readyState === 'complete', null, { timeout: 120000 });
    await page.waitForTimeout(1000);
    const first = await page.evaluate(() => window.firstPicture);
    const loaded = await spent();
    const scrubbed = await page.evaluate(scrub);
    const after = await spent();
    const turned = await page.evaluate(turn);
    return {
      'first picture (ms)': first, 'page to its end: thread (ms)': loaded.thread, 'page to its end: scripts (ms)': loaded.scripts,
      'scrubbing (pictures/s)': scrubbed.draws / scrubbed.seconds,
      'a picture: thread (ms)': (after.thread - loaded.thread) / scrubbed.draws,
      'a picture: scripts (ms)': (after.scripts - loaded.scripts) / scrubbed.draws,
      'turning (pictures/s)': turned.draws / turned.seconds,
    };
  } finally {
    await browser.close();
  }
}

const short = (value) => (value >= 100 ? value.toFixed(0) : value.toPrecision(3));

const found = await findBrowser();
if (found.missing) throw new Error(found.missing);
try {
  const rounds = option('--rounds', files.length > 1 ? 3 : 1);
  const measured = files.map(() => []);
  for (let round = 0; round < rounds; ++round) for (const [k, file] of files.entries()) measured[k].push(await measure(found, file));
  for (const [k, file] of files.entries()) {
    console.log(`${basename(file)}, ${(statSync(file).size / 1e6).toFixed(1)} MB`);
    for (const name of Object.keys(measured[k][0])) {
      const values = measured[k].map((entry) => entry[name]).sort((a, b) => a - b);
      console.log(`  ${name.padEnd(32)} ${short(values[values.length >> 1]).padStart(8)}   best of ${rounds} ${short(/\/s/.test(name) ? values.at(-1) : values[0])}`);
    }
  }
} finally {
  rmSync(folder, { recursive: true, force: true });
}
