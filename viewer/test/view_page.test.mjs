// The view of a page: colours, layers, cameras, ruler, picture. Skipped with 77 where there is no Chromium.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import test from 'node:test';
import { findBrowser, skipIfMissing } from './browser.mjs';
import { browserPages, colours, isSame, picture, pixels } from './use_page.mjs';

const found = await findBrowser();
skipIfMissing(found);
const { onPage, run } = browserPages('view_page', found);

test('every colouring draws another picture, and its legend has numbers and units', async () => {
  await onPage(`${run()}#frame=6`, async (page) => {
    const pictures = [];
    for (const [key, legend] of [['1', /−\d+.*\+\d+/s], ['2', /measured \(m\/s\)/], ['3', /static.*moving.*not used/s], ['4', /Residual \(m\).*0\.2/s], ['5', /Height \(m\)/]]) {
      await page.keyboard.press(key);
      pictures.push((await picture(page)).toString('base64'));
      assert.match(await page.textContent('.legend'), legend);
    }
    assert.equal(new Set(pictures).size, 5);
    await page.selectOption('.toolbar select', 'compensated');
    const usual = await picture(page);
    assert.equal(usual.toString('base64'), pictures[0]);
    await page.click('[aria-label^="Narrower range"]');
    assert.ok(!usual.equals(await picture(page)));
  });
});

test('every layer changes the picture, and back', async () => {
  await onPage(`${run()}#frame=6`, async (page) => {
    const before = await picture(page);
    await page.click('.menu summary');
    for (const layer of ['still', 'moving', 'unused', 'boxes', 'arrows', 'predicted', 'path', 'truth', 'map', 'traces', 'rings', 'sensor']) {
      const box = page.locator(`[data-layer="${layer}"]`);
      const labels = await page.locator('.labels').innerText();
      await box.click();
      assert.ok(!before.equals(await picture(page)), layer);
      assert.equal(await page.locator('.labels').innerText() === labels, layer !== 'rings', layer);
      await box.click();
      assert.ok(before.equals(await picture(page)), `${layer} and back`);
    }
    assert.match(await page.locator('.labels').innerText(), /6 · ~\d+ m\/s/);
    await page.keyboard.press('i');
    await picture(page);
    assert.doesNotMatch(await page.locator('.labels').innerText(), /m\/s/);
  });
});

test('predicted points stand beside the measured ones, in two colours and two shapes', async () => {
  await onPage(`${run()}#frame=6&layers=predicted&size=4`, async (page) => {
    const counts = await colours(page);
    const [measured, predicted] = [counts['209,53,15'] ?? 0, counts['0,138,99'] ?? 0];
    assert.ok(measured > 30 && predicted > 30, `${measured} and ${predicted} pixels`);
    assert.match(await page.textContent('.legend'), /measured.*at the next scan/s);
  });
});

test('cameras: follow goes along, free stays, top looks down; reset puts them back', async () => {
  await onPage(`${run()}#frame=6`, async (page) => {
    const pictures = [await picture(page)];
    for (const key of ['v', 'c']) {
      await page.keyboard.press(key);
      if (key === 'v') await page.keyboard.press('r');
      pictures.push(await picture(page));
    }
    assert.equal(new Set(pictures.map((image) => image.toString('base64'))).size, 3);
    await page.keyboard.press('f');
    assert.ok(await isSame(page, await picture(page), pictures[0]));
    const box = await page.locator('canvas.scene').boundingBox();
    await page.mouse.move(box.x + 300, box.y + 300);
    await page.mouse.down();
    await page.mouse.move(box.x + 420, box.y + 330, { steps: 4 });
    await page.mouse.up();
    assert.ok(!(await isSame(page, await picture(page), pictures[0])));
    await page.click('[aria-label^="Reset camera"]');
    assert.ok(await isSame(page, await picture(page), pictures[0]));
  });
});

test('from above lengths are true: the ruler reads the same everywhere, and the axes say metres', async () => {
  await onPage(`${run()}#frame=6&camera=top&layers=rings`, async (page) => {
    await picture(page);
    const axes = await page.locator('canvas.overlay').screenshot();
    await page.keyboard.press('l');
    assert.equal(await page.getAttribute('[aria-label^="Ruler"]', 'aria-pressed'), 'true');
    const box = await page.locator('canvas.scene').boundingBox();
    const [cx, cy] = [box.x + box.width / 2, box.y + box.height / 2];
    // The sensor is in the middle; the circle of 40 m tells how many pixels are a metre.
    const ring = await page.locator('.labels .ring:text-is("40 m")').boundingBox();
    const perMetre = (ring.y + ring.height - cy) / 40;
    assert.ok(perMetre > 1, `${perMetre} pixels a metre`);
    await page.mouse.click(cx + 10 * perMetre, cy);
    await page.mouse.click(cx + 30 * perMetre, cy);
    const far = await page.locator('canvas.overlay').screenshot();
    assert.ok(!axes.equals(far));
    await page.keyboard.press('Escape');
    assert.equal(await page.getAttribute('[aria-label^="Ruler"]', 'aria-pressed'), 'false');
    let isCleared = false; // with the next picture
    for (let tries = 0; tries < 40 && !isCleared; ++tries) {
      await page.waitForTimeout(50);
      isCleared = axes.equals(await page.locator('canvas.overlay').screenshot());
    }
    assert.ok(isCleared);
    await page.keyboard.press('f');
    await picture(page);
    assert.ok(await page.locator('canvas.overlay').isHidden());
  });
});

test('the view is saved as a PNG of the size it has', async () => {
  await onPage(`${run()}#frame=6&camera=top`, async (page) => {
    await picture(page);
    const [download] = await Promise.all([page.waitForEvent('download'), page.click('[aria-label^="Save the view"]')]);
    assert.match(download.suggestedFilename(), /^street_Dynamic-ICP-6\.png$/);
    const png = readFileSync(await download.path());
    assert.equal(png.toString('latin1', 1, 4), 'PNG');
    const box = await page.locator('canvas.scene').boundingBox();
    assert.deepEqual([png.readUInt32BE(16), png.readUInt32BE(20)], [Math.round(box.width), Math.round(box.height) + 30]);
    const data = await pixels(page, png);
    const seen = new Set();
    for (let i = 0; i < data.length; i += 4) seen.add(data.readUInt32BE(i));
    assert.ok(seen.size > 50, 'it is not blank');
  });
});

test('a click on a point tells what is known of it', async () => {
  await onPage(`${run()}#frame=6&camera=top&layers=still&size=6`, async (page) => {
    await picture(page);
    const box = await page.locator('canvas.scene').boundingBox();
    for (let k = 0; k < 40 && !(await page.locator('.point-reading').isVisible()); ++k) {
      await page.mouse.click(box.x + box.width / 2 - 100 + 9 * k, box.y + box.height / 2 - 60 + 4 * k);
    }
    assert.match(await page.textContent('.point-reading'), /range.*m.*Doppler.*m\/s.*static/s);
  });
});
