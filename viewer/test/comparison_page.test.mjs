// Pages of several runs. Skipped with 77 where there is no Chromium.
import assert from 'node:assert/strict';
import test from 'node:test';
import { findBrowser, skipIfMissing } from './browser.mjs';
import { samples } from './sample_page.mjs';
import { browserPages, isSame, picture, pixels, shown } from './use_page.mjs';

const found = await findBrowser();
skipIfMissing(found);
const { onPage, write } = browserPages('comparison_page', found);

test('a comparison: the table first, sorted by any column; runs over each other, one brought to the front', async () => {
  await onPage(write('comparison', samples.comparison()), async (page) => {
    assert.equal((await page.$$('.chip')).length, 3);
    const best = await page.$$eval('.numbers .best', (cells) => cells.map((cell) => cell.textContent));
    assert.deepEqual(best, ['★6.67 mm', '★0.00200°'], 'scans per second read the same for all: nobody wins');
    assert.deepEqual(await page.$$eval('.numbers .second', (cells) => cells.map((cell) => cell.textContent)), ['40.0 mm', '0.0120°']);
    const table = await page.locator('.results').boundingBox();
    assert.ok(table.y < 100 && table.width > 1200, 'on top, as wide as the page');
    const names = () => page.$$eval('.results > .text-sheet .numbers tbody th', (cells) => cells.map((cell) => cell.textContent));
    const sort = page.locator('.numbers th button:has-text("translation error")');
    await sort.click();
    assert.deepEqual(await names(), ['dynamic-icp', 'kiss-icp', 'gicp']);
    await sort.click();
    assert.deepEqual(await names(), ['gicp', 'kiss-icp', 'dynamic-icp']);
    assert.equal(await page.getAttribute('.numbers th:has-text("translation error")', 'aria-sort'), 'descending');

    assert.match(await page.getAttribute('[data-plot="translation_error"] canvas', 'aria-label'), /dynamic-icp.*kiss-icp.*gicp/s);
    // All of the trajectories is in sight.
    const data = await pixels(page, await picture(page));
    const width = Math.round((await page.locator('canvas.scene').boundingBox()).width);
    const columns = new Set();
    for (let i = 0; i < data.length; i += 4) {
      if (data[i] === 0 && data[i + 1] === 158 && data[i + 2] === 115) columns.add((i / 4) % width); // gicp, over the others
    }
    assert.ok(Math.min(...columns) > 10 && Math.max(...columns) < width - 10 && columns.size > 0.3 * width, `${columns.size} of ${width}`);
    // What is on the canvas itself: whatever else moves with the pointer is no part of it.
    const drawnPlot = async () =>
      Buffer.from((await page.$eval('[data-plot="translation_error"] canvas', (canvas) => canvas.toDataURL())).split(',')[1], 'base64');
    await page.locator('[data-plot="translation_error"]').scrollIntoViewIfNeeded();
    const plain = await drawnPlot();
    await page.hover('.chip:has-text("gicp")');
    assert.ok(!(await isSame(page, await drawnPlot(), plain)), 'a run that is pointed at stands out');
    await page.hover('h1');
    assert.ok(await isSame(page, await drawnPlot(), plain));
    await page.click('.tabs >> text=CDF');
    assert.match(await page.getAttribute('[data-plot="translation_error-distribution"] canvas', 'aria-label'), /kiss-icp from 0 to 100/);
    const all = await picture(page);
    await page.click('[aria-label="Show gicp"]');
    assert.ok(!all.equals(await picture(page)));
    assert.equal((await page.$$('[data-plot="translation_error-distribution"] .reading')).length, 2);
    await page.click('.chip button:has-text("kiss-icp")');
    await page.waitForFunction(() => /No scans in this page/.test(document.querySelector('.status-note').textContent));
    await page.click('.tabs >> text=Run');
    assert.match(await page.textContent('.run-name'), /kiss-icp/);
  });
});

test('a comparison ranks its runs, tells how far containers are apart, and leads to the worst scans', async () => {
  await onPage(write('findings', samples.comparison()), async (page) => {
    const names = (id) => page.$$eval(`[data-ranking="${id}"] .bar-name`, (cells) => cells.map((cell) => cell.textContent));
    assert.deepEqual(await names('rte_rmse_m'), ['dynamic-icp', 'kiss-icp', 'gicp']);
    assert.match(await page.textContent('.apart'), /dynamic-icp and kiss-icp.*0\.125 mm.*24 scans/);
    const links = await page.$$eval('.worst a', (all) => all.map((one) => one.getAttribute('href')));
    assert.ok(links.length > 0 && links.every((href) => /^run%20of%20%231\/report\.html#frame=\d+$/.test(href)), String(links));
    const button = page.locator('.worst tbody button').first();
    const scan = Number(await button.textContent());
    await button.click();
    await shown(page, scan - 100);
    assert.equal(await page.inputValue('[aria-label="Run in front"]'), '2', 'the worst scan is of gicp');
    await page.click('[aria-label="Show kiss-icp"]');
    assert.deepEqual(await names('rte_rmse_m'), ['dynamic-icp', 'gicp'], 'what is not shown is not ranked');
    await page.click('.tabs >> text=Distance');
    assert.match(await page.getAttribute('[data-plot="drift"] canvas', 'aria-label'), /dynamic-icp from .*gicp from/s);
  });
});

test('a benchmark ranks over all of its drives', async () => {
  await onPage(write('drives', samples.benchmark()), async (page) => {
    assert.match(await page.textContent('.findings'), /Median over 2 drives/);
    assert.match(await page.getAttribute('[data-ranking="rte_rmse_m"] li', 'title'), /street .*tunnel/);
  });
});

for (const width of [1600, 1000, 420]) {
  test(`a comparison, ${width} wide: nothing sticks out`, async () => {
    await onPage(write('wide', samples.comparison()), async (page) => {
      assert.equal(await page.evaluate(() => document.documentElement.scrollWidth), width);
      for (const bar of await page.$$('.bar')) assert.ok((await bar.boundingBox()).width > 80);
    }, { context: { viewport: { width, height: 900 } } });
  });
}

test('a method has the colour its page says, and ablations are shown when they are asked for', async () => {
  const content = samples.comparison();
  content.parts[0].run.colour = 6;
  content.parts[2].run.facts.push(['ablation', 'no-planes']);
  await onPage(write('ablation', content), async (page) => {
    assert.deepEqual(await page.$$eval('.chip input', (boxes) => boxes.map((box) => box.checked)), [true, true, false]);
    assert.equal(await page.$eval('.chip .swatch', (swatch) => swatch.style.getPropertyValue('--swatch')), '#6b4fa0');
    await page.click('[aria-label="Show gicp"]');
    await page.waitForFunction(() => /hidden=(&|$)/.test(location.hash));
    await page.reload();
    await page.waitForSelector('.chip');
    assert.deepEqual(await page.$$eval('.chip input', (boxes) => boxes.map((box) => box.checked)), [true, true, true]);
  });
});

test('a benchmark shows its tables and each of its sequences', async () => {
  await onPage(write('benchmark', samples.benchmark()), async (page) => {
    assert.match(await page.textContent('.results'), /Accuracy.*tunnel.*★0\.007/s);
    const street = await picture(page);
    await page.selectOption('[aria-label="Sequence"]', '1');
    assert.ok(!street.equals(await picture(page)));
    assert.match(await page.locator('.results > .text-sheet').last().textContent(), /tunnel.*24/s);
    assert.equal((await page.$$('.chip')).length, 2);
    await page.click('.warning-count');
    assert.match(await page.textContent('#sheet-summary'), /^[^]*degenerate/);
  });
});
