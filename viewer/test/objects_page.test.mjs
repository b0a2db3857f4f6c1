// The objects of a page: selecting, following, their colours. Skipped with 77 where there is no Chromium.
import assert from 'node:assert/strict';
import test from 'node:test';
import { findBrowser, skipIfMissing } from './browser.mjs';
import { browserPages, colours, isSame, picture, shown } from './use_page.mjs';

const found = await findBrowser();
skipIfMissing(found);
const { onPage, run } = browserPages('objects_page', found);

/** A pixel of the view where an object's box is: the place of its label, a little below. */
async function placeOf(page, id) {
  const box = await page.locator(`.labels span:visible:text-matches("^${id} · ")`).boundingBox();
  return [box.x + box.width / 2, box.y + box.height + 8];
}

test('objects: a key, a click in the view or on a row selects one, marks it, and tells what is known of it', async () => {
  await onPage(`${run()}#frame=6`, async (page) => {
    const plain = await picture(page);
    assert.ok(await page.locator('.object-card').isHidden());
    await page.keyboard.press('x');
    const nearest = Number(/Object (\d+)/.exec(await page.textContent('.object-card'))[1]);
    assert.ok(!plain.equals(await picture(page)));
    const counts = await colours(page);
    assert.ok((counts['194,0,122'] ?? 0) > 30, 'box and points in the colour of the selection');
    await page.keyboard.press('x');
    assert.doesNotMatch(await page.textContent('.object-card'), new RegExp(`Object ${nearest}\\D`));
    await page.keyboard.press('Escape');
    assert.ok(await page.locator('.object-card').isHidden());
    assert.ok(plain.equals(await picture(page)));

    await page.mouse.click(...await placeOf(page, 6));
    assert.match(await page.textContent('.object-card'), /Object 6.*speed15 ± 0\.3 m\/s.*4\.4 × 1\.8 × 1\.5 m.*seen in\d+ scans.*age7 scans.*not observed/s);
    await page.click('.object-card >> text=Track');
    assert.match(await page.textContent('#sheet-objects'), /Object 6.*faces seenfront, left.*faces hiddenright/s);
    assert.match(await page.getAttribute('[data-plot="track-speed"] canvas', 'aria-label'), /speed, ± 1 sigma from 15 to 15/);
    assert.equal(await page.getAttribute('.tracks [aria-label="Object 6"]', 'aria-pressed'), 'true');
    await page.waitForFunction(() => /object=6/.test(location.hash));

    // By keyboard: from row to row, Enter selects, whose points are in the scan.
    await page.focus('.tracks tbody button');
    await page.keyboard.press('ArrowDown');
    const second = await page.evaluate(() => document.activeElement.textContent);
    await page.keyboard.press('Enter');
    assert.match(await page.textContent('#sheet-objects h2'), new RegExp(`Object ${second}$`));
    await page.click('.tracks >> text=m/s');
    assert.equal(await page.getAttribute('.tracks th:has-text("m/s")', 'aria-sort'), 'descending');
    const speeds = await page.$$eval('.tracks tbody tr', (rows) => rows.map((row) => parseFloat(row.children[3].textContent)));
    assert.deepEqual(speeds, [...speeds].sort((a, b) => b - a));
  });
});

test('the camera follows a selected object, and the sensor again', async () => {
  await onPage(`${run()}#frame=6&object=6`, async (page) => {
    await page.waitForSelector('.object-card:not([hidden])');
    const bySensor = await picture(page);
    await page.click('.object-card >> text=Follow');
    assert.ok(!(await isSame(page, await picture(page), bySensor)));
    const [x, y] = await placeOf(page, 6);
    await page.keyboard.press('Shift+ArrowRight');
    await shown(page, 16);
    await picture(page);
    const [x2, y2] = await placeOf(page, 6);
    assert.ok(Math.hypot(x2 - x, y2 - y) < 25, `it stays where it is: ${x}, ${y} and ${x2}, ${y2}`);
    await page.waitForFunction(() => /chase=1/.test(location.hash));
    await page.keyboard.press('Shift+ArrowLeft');
    await shown(page, 6);
    await page.keyboard.press('w');
    assert.ok(await isSame(page, await picture(page), bySensor));
  });
});

test('boxes are neutral while colours tell the Doppler, and have those of their ids in the segmentation', async () => {
  await onPage(`${run()}#frame=6&layers=boxes`, async (page) => {
    const box = '59,69,84';
    assert.ok((await colours(page))[box] > 30);
    await page.keyboard.press('3');
    assert.equal((await colours(page))[box] ?? 0, 0);
    await page.keyboard.press('p'); // whose crosses have colours of their own
    assert.ok((await colours(page))[box] > 30);
  });
});
