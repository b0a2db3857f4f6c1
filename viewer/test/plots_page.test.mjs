// The plots and numbers of a page. Skipped with 77 where there is no Chromium.
import assert from 'node:assert/strict';
import test from 'node:test';
import { findBrowser, skipIfMissing } from './browser.mjs';
import { browserPages, shown } from './use_page.mjs';

const found = await findBrowser();
skipIfMissing(found);
const { onPage, run } = browserPages('plots_page', found);

test('a click on a plot goes to that frame; hovering reads the values there', async () => {
  await onPage(`${run()}#frame=0`, async (page) => {
    const area = page.locator('[data-plot="iterations"] .chart-area');
    const box = await area.boundingBox();
    // The axis runs from 44 px to 8 px before the end (time 0 to 2.3 s): 1.5 s is frame 15.
    const x = 44 + ((box.width - 52) * 1.5) / 2.3;
    await area.click({ position: { x, y: 40 } });
    await shown(page, 15);
    assert.equal(await page.inputValue('input.frames'), '15');
    const at15 = await page.textContent('[data-plot="ego_speed"] .reading b');
    await area.hover({ position: { x: 46, y: 30 } });
    assert.match(await page.textContent('[data-plot="iterations"] .chart-at'), /^time 0/);
    assert.equal(await page.textContent('[data-plot="ego_speed"] .reading b'), at15);
    await page.keyboard.down('Shift'); // a drag with Shift scrubs
    await page.mouse.down();
    await page.mouse.move(box.x + 44 + ((box.width - 52) * 0.8) / 2.3, box.y + 30, { steps: 5 });
    await page.mouse.up();
    await page.keyboard.up('Shift');
    await shown(page, 8);
    assert.ok(await page.locator('.zoomed').isHidden());
  });
});

test('a drag over a plot zooms all of them in time, a double click shows all again; so do keys', async () => {
  await onPage(`${run()}#frame=5`, async (page) => {
    const area = page.locator('[data-plot="iterations"] .chart-area');
    const box = await area.boundingBox();
    const at = (seconds) => box.x + 44 + ((box.width - 52) * seconds) / 2.3;
    const speed = page.locator('[data-plot="ego_speed"] canvas');
    const whole = await speed.screenshot();
    await page.mouse.move(at(0.5), box.y + 30);
    await page.mouse.down();
    await page.mouse.move(at(1.5), box.y + 30, { steps: 5 });
    assert.ok(await page.locator('[data-plot="iterations"] .selection').isVisible());
    await page.mouse.up();
    assert.match(await page.textContent('.zoomed'), /^Time 0\.5 to 1\.5 s/);
    assert.ok(!whole.equals(await speed.screenshot()), 'other plots go along');
    await shown(page, 5);
    await area.click({ position: { x: 44 + (box.width - 52) / 2, y: 30 } }); // now 1.0 s
    await shown(page, 10);
    await page.waitForFunction(() => /zoom=0\.\d+,1\.\d+/.test(location.hash));
    await area.dblclick({ position: { x: 44 + (box.width - 52) / 2, y: 30 } });
    assert.ok(await page.locator('.zoomed').isHidden());
    await page.keyboard.press('z');
    assert.ok(await page.locator('.zoomed').isVisible());
    await page.keyboard.press('Shift+Z');
    assert.ok(await page.locator('.zoomed').isHidden());
  });
});

test('plots can be folded, which the address keeps', async () => {
  await onPage(`${run()}#frame=5`, async (page) => {
    const fold = page.locator('[data-plot="ego_speed"] .fold');
    await fold.click();
    assert.equal(await fold.getAttribute('aria-expanded'), 'false');
    assert.ok(await page.locator('[data-plot="ego_speed"] .chart-area').isHidden());
    assert.ok(await page.locator('[data-plot="iterations"] .chart-area').isVisible());
    assert.equal(await page.evaluate(() => document.activeElement.closest('.chart')?.dataset.plot), 'ego_speed', 'focus stays');
    await page.waitForFunction(() => /folded=ego_speed/.test(location.hash));
    await page.keyboard.press('Enter');
    assert.ok(await page.locator('[data-plot="ego_speed"] .chart-area').isVisible());
  });
});

test('the numbers one asks for first are on top, and the summary is a table', async () => {
  await onPage(run(), async (page) => {
    assert.match(await page.textContent('.headline'), /methoddynamic-icp.*scans24.*RTE6\.67 mm.*RRE0\.00200°.*status\d+ ok\d+ degenerate\d+ lost/s);
    await page.click('.tabs >> text=Summary');
    assert.deepEqual(await page.$$eval('.measures tr', (rows) => rows.map((row) => row.textContent)), ['RMSE', 'RTE6.67 mm', 'RRE0.00200°']);
  });
});
