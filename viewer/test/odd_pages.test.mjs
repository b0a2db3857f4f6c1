// Pages of which something is missing, damaged or hostile. Skipped with 77 where there is no Chromium.
import assert from 'node:assert/strict';
import { writeFileSync } from 'node:fs';
import { join } from 'node:path';
import test from 'node:test';
import { findBrowser, openPage, skipIfMissing } from './browser.mjs';
import { pageOf, sampleRun, samples } from './sample_page.mjs';
import { browserPages, colours, frameOf, shown, whole } from './use_page.mjs';

const found = await findBrowser();
skipIfMissing(found);
const { onPage, run, write, own } = browserPages('odd_pages', found);

const HOSTILE = '</script><script>window.broken=1</script><img src=x onerror="window.broken=1">"\'&amp;<!-- \u2028 ${1} ';

test('hostile texts are shown as texts', async () => {
  const texts = {
    name: HOSTILE, facts: [[HOSTILE, HOSTILE]], command: HOSTILE, warnings: [HOSTILE], origin: [[HOSTILE, HOSTILE]],
    configuration: [[HOSTILE, HOSTILE]], summary: [{ key: HOSTILE, value: HOSTILE, meaning: HOSTILE, number: 1, better: 'lower' }],
  };
  const part = sampleRun({ texts });
  part.run.pictures.push({ title: HOSTILE, caption: HOSTILE, svg: HOSTILE });
  part.run.frames.reason.fill(HOSTILE);
  part.run.frames.status.fill(HOSTILE);
  part.run.frames.lost_directions.fill([HOSTILE]);
  for (const plot of part.run.plots) Object.assign(plot, { title: HOSTILE, unit: HOSTILE }, plot.series.forEach((series) => { series.name = HOSTILE; }));
  const tables = [{ title: HOSTILE, caption: HOSTILE, columns: [HOSTILE], rows: [[HOSTILE]], best: [[true]] }];
  const content = { kind: 'benchmark', title: HOSTILE, parts: [part], notes: [HOSTILE], groups: [{ name: HOSTILE, runs: [0] }], tables };
  await onPage(write('hostile', content), async (page) => {
    for (const tab of await page.$$('.tabs button')) {
      await tab.click();
      const visible = await page.$eval('.sheet:not([hidden])', (sheet) => sheet.textContent);
      if ((await tab.textContent()) !== 'CDF') assert.ok(visible.includes(HOSTILE), await tab.textContent());
    }
    assert.equal(await page.title(), HOSTILE.replace(/[ \n]+/g, ' ').trim());
    assert.ok((await page.textContent('h1')) === HOSTILE);
    assert.equal(await page.evaluate(() => window.broken), undefined);
    const sources = await page.$$eval('img', (images) => images.map((image) => image.src));
    assert.deepEqual(sources.map((source) => source.startsWith('data:image/svg+xml')), [true, true], 'the two pictures of the part');
    assert.equal(await page.evaluate(() => document.documentElement.scrollWidth), 1280);
  });
});

test('frames without their own scan show the one before, and say so', async () => {
  await onPage(`${write('sparse', samples.run({ keepEvery: 4 }))}#frame=6`, async (page) => {
    await shown(page, 6);
    assert.match(await page.textContent('.status-note'), /points of frame 4/);
    await page.fill('input.frames', '8');
    await shown(page, 8);
    assert.doesNotMatch(await page.textContent('.status-note'), /points of frame/);
  });
});

test('a run without truth, scans, map and objects still has its page', async () => {
  const part = sampleRun({ truth: false, scans: false, map: false });
  part.run.frames.objects = part.run.frames.objects.map(() => []);
  part.run.frames.poses.fill(null, 35, 42);
  await onPage(write('bare', { kind: 'run', title: 'bare', parts: [part] }), async (page) => {
    await page.keyboard.press('Home');
    await shown(page, 0);
    await page.fill('input.frames', '5'); // has no pose
    await shown(page, 5);
    assert.ok(Object.keys(await colours(page)).length > 3);
    await page.click('.menu summary');
    assert.deepEqual(await page.$$eval('[data-layer]', (boxes) => boxes.map((box) => box.dataset.layer)), ['path', 'rings', 'sensor']);
  });
});

test('a run without frames and a benchmark without runs have their page', async () => {
  await onPage(write('empty', samples.run({ frames: 0 })), async (page) => {
    await page.keyboard.press('End');
    await page.keyboard.press('n');
    assert.equal(await frameOf(page), 0);
  });
  const { tables } = samples.benchmark();
  const content = { kind: 'benchmark', title: 'tables', parts: [], groups: [{ name: 'street', runs: [] }], tables, notes: ['runs left out'] };
  const { page, troubles } = await openPage(own.browser, write('tables', content));
  assert.match(await page.textContent('#app'), /Accuracy.*★0\.007.*runs left out/s);
  assert.deepEqual(troubles, []);
  await page.context().close();
});

test('a single frame is a run', async () => {
  await onPage(write('single', samples.run({ frames: 1 })), async (page) => {
    await shown(page, 0);
    await page.keyboard.press('Space');
    await page.keyboard.press('ArrowRight');
    assert.equal(await frameOf(page), 0);
  });
});

test('a damaged scan is told, and the others stay', async () => {
  const part = sampleRun();
  part.scans[6] = part.scans[6].subarray(0, 100);
  await onPage(`${write('damaged', { kind: 'run', title: 'damaged', parts: [part] })}#frame=6`, async (page) => {
    await page.waitForFunction(() => /scan of frame 6 cannot be read/.test(document.querySelector('.status-note').textContent));
    await page.keyboard.press('ArrowRight');
    await shown(page, 7);
    assert.doesNotMatch(await page.textContent('.status-note'), /cannot be read/);
  });
});

test('without DecompressionStream the page says so and the rest works', async () => {
  const { page, troubles } = await openPage(own.browser, 'about:blank');
  await page.addInitScript(() => { delete window.DecompressionStream; });
  await page.goto(run());
  await page.waitForFunction(() => /lacks DecompressionStream/.test(document.querySelector('.status-note')?.textContent));
  await whole(page);
  assert.ok((await page.$$('.chart')).length >= 8);
  assert.deepEqual(troubles.filter((text) => !text.startsWith('request: file:')), []);
  await page.context().close();
});

test('without WebGL the page says so and the rest works', async () => {
  const address = run();
  await own.browser.close();
  own.browser = await found.launch(['--disable-gpu', '--disable-3d-apis']);
  await onPage(`${address}#frame=3`, async (page) => {
    await shown(page, 3);
    assert.match(await page.textContent('.scene-note'), /no WebGL/);
    await page.keyboard.press('ArrowRight');
    await shown(page, 4);
    await page.locator('[data-plot="iterations"] .chart-area').click({ position: { x: 60, y: 30 } });
    assert.notEqual(await frameOf(page), 4);
  });
  await own.browser.close();
  own.browser = await found.launch();
});

test('a page of a newer schema keeps what it shows without the viewer', async () => {
  const address = write('newer', samples.run());
  const file = join(own.folder, 'newer.html');
  writeFileSync(file, pageOf(samples.run(), own.viewer).replace('"schema":1', '"schema":2'));
  const { page } = await openPage(own.browser, address);
  assert.match(await page.textContent('#app'), /did not start: .*schema 2.*Without JavaScript this page shows its numbers/s);
  await page.context().close();
});
