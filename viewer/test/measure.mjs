// How fast a page is, with software rendering: time until the first picture, and frames a second while scrubbing and playing.
//   node test/measure.mjs PAGE.html                       a page that is there
//   node test/measure.mjs [--frames 1000] [--points 3500] a page of an invented drive
import { mkdtempSync, rmSync, statSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join, resolve } from 'node:path';
import { pathToFileURL } from 'node:url';
import { bundle } from '../build.mjs';
import { findBrowser, openPage } from './browser.mjs';
import { pageOf, sampleRun } from './sample_page.mjs';

const args = process.argv.slice(2);
const option = (name, usual) => (args.includes(name) ? Number(args[args.indexOf(name) + 1]) : usual);
const folder = mkdtempSync(join(tmpdir(), 'viewer-measure-'));
let file = args.find((argument) => argument.endsWith('.html'));
if (!file) {
  const [frames, points] = [option('--frames', 1000), option('--points', 3500)];
  file = join(folder, 'page.html');
  writeFileSync(file, pageOf({ kind: 'run', title: `${frames} frames of ${points} points`, parts: [sampleRun({ frames, points, unit: 0.02 })] }, await bundle()));
}

const found = await findBrowser();
if (found.missing) throw new Error(found.missing);
const browser = await found.launch();
try {
  const { page } = await openPage(browser, 'about:blank');
  const began = performance.now();
  await page.goto(pathToFileURL(resolve(file)).href, { waitUntil: 'commit' });
  await page.waitForSelector('.scene-holder[data-draws]', { state: 'attached', timeout: 60000 });
  await page.waitForFunction(() => document.querySelector('.scene-holder').dataset.frame !== undefined);
  const opened = performance.now() - began;

  // The slider is moved at every picture the browser shows; what counts is how many different frames were drawn.
  const scrub = await page.evaluate(async () => {
    const holder = document.querySelector('.scene-holder');
    const slider = document.querySelector('input.frames');
    const last = Number(slider.max);
    const drawn = new Set();
    let draws = 0;
    new MutationObserver(() => { ++draws; drawn.add(holder.dataset.frame); }).observe(holder, { attributes: true, attributeFilter: ['data-draws'] });
    const start = performance.now();
    let k = 0;
    while (performance.now() - start < 6000) {
      slider.value = String((37 * k++) % (last + 1)); // jumps, so that nothing is decoded before
      slider.dispatchEvent(new Event('input', { bubbles: true }));
      await new Promise(requestAnimationFrame);
    }
    return { draws, seconds: (performance.now() - start) / 1000, moves: k };
  });
  const turn = await page.evaluate(async () => {
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
  });
  const { size } = statSync(file);
  console.log(`page              ${(size / 1e6).toFixed(1)} MB`);
  console.log(`first picture     ${(opened / 1000).toFixed(2)} s`);
  console.log(`scrubbing         ${(scrub.draws / scrub.seconds).toFixed(1)} frames/s (${scrub.moves} moves in ${scrub.seconds.toFixed(1)} s)`);
  console.log(`turning the view  ${(turn.draws / turn.seconds).toFixed(1)} pictures/s`);
} finally {
  await browser.close();
  rmSync(folder, { recursive: true, force: true });
}
