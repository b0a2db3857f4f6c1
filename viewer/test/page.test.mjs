// The page as a reader meets it, opened from a file by a headless Chromium: timeline, address, sizes, keys.
// Skipped with 77 where there is no Chromium.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { createServer } from 'node:http';
import { fileURLToPath } from 'node:url';
import test from 'node:test';
import { findBrowser, openPage, skipIfMissing } from './browser.mjs';
import { browserPages, colours, frameOf, isSame, picture, shown, whole } from './use_page.mjs';

const found = await findBrowser();
skipIfMissing(found);
const { onPage, own, run } = browserPages('page', found);

test('the view is not blank, and nothing is asked for but the page', async () => {
  await onPage(run(), async (page) => {
    const counts = await colours(page);
    assert.ok(Object.keys(counts).length > 50, `only ${Object.keys(counts).length} colours`);
    assert.ok((await page.$$('.chart')).length >= 8);
  });
});

test('the first scan is drawn while the rest of the page is still on its way; other scans wait for it', async () => {
  const html = readFileSync(fileURLToPath(run()));
  const cut = html.indexOf('</script>', html.indexOf('id="scan-0-1"')) - 20; // in the middle of a scan
  let finish = null;
  const server = createServer((request, response) => {
    response.writeHead(200, { 'content-type': 'text/html; charset=utf-8' });
    response.write(html.subarray(0, cut));
    finish = () => response.end(html.subarray(cut));
  });
  await new Promise((listening) => { server.listen(0, '127.0.0.1', listening); });
  const { page } = await openPage(own.browser, 'about:blank');
  await page.addInitScript(() => { // browsers take no picture of a page before its end; it has to be copied where it is drawn
    new MutationObserver(() => {
      const canvas = document.querySelector('canvas.scene');
      const copy = new OffscreenCanvas(canvas.width, canvas.height).getContext('2d');
      copy.drawImage(canvas, 0, 0);
      window.coloursDrawn = new Set(new Uint32Array(copy.getImageData(0, 0, canvas.width, canvas.height).data.buffer)).size;
    }).observe(document, { subtree: true, attributes: true, attributeFilter: ['data-draws'] });
  });
  try {
    await page.goto(`http://127.0.0.1:${server.address().port}/`, { waitUntil: 'commit' });
    await shown(page, 6); // a quarter of the way into the drive
    assert.equal(await page.evaluate(() => document.readyState), 'loading');
    assert.ok(await page.evaluate(() => window.coloursDrawn) > 50, 'with its points');
    await page.fill('input.frames', '1');
    await page.waitForTimeout(300);
    assert.equal(await frameOf(page), 6);
    finish();
    await shown(page, 1);
    await whole(page);
    assert.doesNotMatch(await page.textContent('.status-note'), /cannot/);
  } finally {
    await page.context().close();
    server.closeAllConnections();
    server.close();
  }
});

test('scrubbing, stepping, keys and the ends of the timeline change the frame and the picture', async () => {
  await onPage(`${run()}#frame=5`, async (page) => {
    await shown(page, 5);
    const first = await picture(page);
    await page.fill('.timeline input.frames', '11');
    await shown(page, 11);
    assert.ok(!first.equals(await picture(page)));
    await page.click('[aria-label^="One frame on"]');
    await shown(page, 12);
    await page.keyboard.press('ArrowLeft');
    await shown(page, 11);
    await page.keyboard.press('Shift+ArrowLeft');
    await shown(page, 1);
    await page.keyboard.press('End');
    await shown(page, 23);
    await page.keyboard.press('Home');
    await shown(page, 0);
    await page.keyboard.press('n');
    await shown(page, 7);
    assert.match(await page.textContent('.status'), /degenerate.*planes alone do not hold the position.*along x/s);
    await page.keyboard.press('n');
    await shown(page, 12);
    assert.match(await page.textContent('.status .badge'), /lost/);
  });
});

test('playing goes on by itself, stops at the end, and begins again', async () => {
  await onPage(`${run()}#frame=0&speed=8`, async (page) => {
    await page.click('.play');
    await shown(page, 23);
    await page.waitForSelector('.play[aria-pressed="false"]');
    for (let k = 0; k < 3; ++k) await page.keyboard.press(',');  // slow enough to be stopped on the way
    await page.keyboard.press('Space');
    await page.waitForFunction(() => Number(document.querySelector('.scene-holder').dataset.frame) < 20);
    await page.keyboard.press('Space');
    await page.waitForSelector('.play[aria-pressed="false"]');
    const frame = Number(await page.inputValue('.timeline input.frames'));
    await shown(page, frame);  // a slow machine draws behind the timeline
    await page.waitForTimeout(300);
    assert.equal(Number(await page.inputValue('.timeline input.frames')), frame);
    assert.equal(await frameOf(page), frame);
  });
});

test('the address holds the state, and a reload brings it back', async () => {
  await onPage(`${run()}#frame=4`, async (page) => {
    await page.keyboard.press('3');
    await page.keyboard.press('b');
    await page.keyboard.press('v');
    await page.fill('input.frames', '9');
    await page.click('text=Summary');
    const box = await page.locator('canvas.scene').boundingBox();
    await page.mouse.move(box.x + 200, box.y + 300);
    await page.mouse.down();
    await page.mouse.move(box.x + 330, box.y + 280, { steps: 4 });
    await page.mouse.up();
    await page.mouse.move(5, 5);
    const before = await picture(page);
    await page.waitForFunction(() => /eye=/.test(location.hash) && /frame=9/.test(location.hash));
    await page.waitForTimeout(400);
    const hash = await page.evaluate(() => location.hash);
    assert.match(hash, /colour=kind/);
    assert.match(hash, /camera=free/);
    assert.match(hash, /tab=summary/);
    assert.doesNotMatch(hash, /boxes/);
    await page.reload();
    await shown(page, 9);
    assert.equal(await page.locator('[data-camera="free"]').getAttribute('aria-pressed'), 'true');
    assert.ok(await page.locator('#sheet-summary').isVisible());
    assert.ok(await isSame(page, await picture(page), before));
  });
});

for (const [width, height] of [[1280, 800], [820, 1180], [390, 844], [360, 640]]) {
  for (const colorScheme of ['light', 'dark']) {
    test(`${width} x ${height}, ${colorScheme}: nothing sticks out, the view is there`, async () => {
      await onPage(run(), async (page) => {
        for (const tab of ['Plots', 'CDF', 'Summary', 'Settings']) {
          await page.click(`.tabs >> text=${tab}`);
          assert.equal(await page.evaluate(() => document.documentElement.scrollWidth), width, tab);
        }
        const box = await page.locator('canvas.scene').boundingBox();
        assert.ok(box.width > 0.55 * Math.min(width, 1000) && box.height > 200);
        await page.click('.menu summary');
        const menu = await page.locator('.menu-body').boundingBox();
        assert.ok(menu.x >= 0 && menu.x + menu.width <= width, `menu from ${menu.x}, ${menu.width} wide`);
        await page.click('.menu summary');
        const ground = await page.evaluate(() => getComputedStyle(document.body).backgroundColor);
        assert.equal(ground, colorScheme === 'dark' ? 'rgb(10, 13, 19)' : 'rgb(238, 240, 244)');
        const counts = await colours(page);
        assert.ok((counts[colorScheme === 'dark' ? '12,16,23' : '250,251,252'] ?? 0) > 1000);
        await page.keyboard.press('t');
        assert.notEqual(await page.evaluate(() => getComputedStyle(document.body).backgroundColor), ground);
      }, { context: { viewport: { width, height }, colorScheme } });
    });
  }
}

test('everything can be reached by the keyboard, has a name, and shows its focus', async () => {
  await onPage(run(), async (page) => {
    const nameless = await page.$$eval('button, input, select, summary', (all) =>
      all.filter((one) => !(one.getAttribute('aria-label') || one.textContent.trim() || one.closest('label')?.textContent.trim())).length);
    assert.equal(nameless, 0);
    const reached = new Set();
    await page.click('h1');
    for (let k = 0; k < 40; ++k) {
      await page.keyboard.press('Tab');
      reached.add(await page.evaluate(() => {
        const one = document.activeElement;
        if (one === document.body) return 'the end';
        return getComputedStyle(one).outlineStyle === 'none' ? `no outline: ${one.className}` : one.getAttribute('aria-label') ?? one.textContent;
      }));
    }
    for (const name of ['Colour of the points', 'Play or pause (space)', 'Frame', 'Point size in pixels', 'Layers', 'Plots']) {
      assert.ok([...reached].some((entry) => entry.startsWith(name)), `${name} in ${[...reached].join(' | ')}`);
    }
    assert.ok(![...reached].some((entry) => entry.startsWith('no outline')), [...reached].join(' | '));
    await page.keyboard.press('?');
    assert.ok(await page.locator('dialog.help').isVisible());
    assert.match(await page.textContent('dialog.help'), /play or pause.*follow the sensor/s);
    await page.keyboard.press('Escape');
    assert.ok(!(await page.locator('dialog.help').isVisible()));
    await page.locator('[role=tab][aria-selected=true]').focus();
    await page.keyboard.press('ArrowRight');
    assert.ok(await page.locator('#sheet-objects').isVisible());
  });
});

test('settings can be searched, the command copied, a link shared', async () => {
  await onPage(`${run()}#tab=configuration&frame=3`, async (page) => {
    await page.fill('input[type=search]', 'kernel');
    assert.deepEqual(await page.$$eval('#sheet-configuration details th', (cells) => cells.map((cell) => cell.textContent)), ['registration.kernel']);
    assert.equal(await frameOf(page), 3); // letters typed there are no keys of the page
    await page.click('.tabs >> text=Summary');
    await page.context().grantPermissions(['clipboard-read', 'clipboard-write']);
    await page.click('.command button');
    assert.match(await page.evaluate(() => navigator.clipboard.readText()), /^dynamic-icp run street/);
    await page.click('text=Copy link');
    assert.match(await page.evaluate(() => navigator.clipboard.readText()), /^file:.*#.*frame=3/);
  });
});
