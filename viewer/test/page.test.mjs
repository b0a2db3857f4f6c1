// The page as a reader meets it, opened from a file by a headless Chromium. Skipped with 77 where there is none.
import assert from 'node:assert/strict';
import { readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import test from 'node:test';
import { pathToFileURL } from 'node:url';
import { findBrowser, openPage, skipIfMissing } from './browser.mjs';
import { pageFiles } from './page_files.mjs';
import { pageOf, sampleRun, samples } from './sample_page.mjs';

const found = await findBrowser();
skipIfMissing(found);

const own = pageFiles('page', found.launch);
const { write } = own;

/** Opens a page, lets `act` use it, and fails when the page wrote an error or asked for anything. */
async function onPage(address, act, options = {}) {
  const { page, troubles } = await openPage(options.browser ?? own.browser, address, options.context);
  try {
    await page.waitForSelector('.scene-holder[data-frame]');
    await act(page);
    assert.deepEqual(troubles, []);
  } finally {
    await page.context().close();
  }
}

const frameOf = (page) => page.$eval('.scene-holder', (holder) => Number(holder.dataset.frame));
const shown = (page, frame) => page.waitForSelector(`.scene-holder[data-frame="${frame}"]`);

// What lies over the view is no part of its picture.
const SCENE_ONLY = '.status, .legend, .point-reading, .menu-body, .labels { visibility: hidden } .scene { outline: none !important }';

/** Waits until nothing is drawn any more, then gives the picture of the view. */
async function picture(page) {
  await page.evaluate(async () => {
    const holder = document.querySelector('.scene-holder');
    let draws = '';
    while (draws !== holder.dataset.draws) {
      draws = holder.dataset.draws;
      await new Promise((done) => setTimeout(done, 120));
    }
  });
  return page.locator('canvas.scene').screenshot({ style: SCENE_ONLY });
}

/** The pixels of a picture, four bytes each. */
async function pixels(page, image) {
  const text = await page.evaluate(async (png) => {
    const bytes = Uint8Array.from(atob(png), (c) => c.charCodeAt(0));
    const bitmap = await createImageBitmap(new Blob([bytes], { type: 'image/png' }));
    const canvas = new OffscreenCanvas(bitmap.width, bitmap.height);
    const pen = canvas.getContext('2d');
    pen.drawImage(bitmap, 0, 0);
    const { data } = pen.getImageData(0, 0, bitmap.width, bitmap.height);
    let binary = '';
    for (let at = 0; at < data.length; at += 8192) binary += String.fromCharCode(...data.subarray(at, at + 8192));
    return btoa(binary);
  }, image.toString('base64'));
  return Buffer.from(text, 'base64');
}

/** Whether two pictures are the same but for the rounding of a place that went through a link or around the sensor. */
async function isSame(page, one, other) {
  const [a, b] = [await pixels(page, one), await pixels(page, other)];
  assert.equal(a.length, b.length);
  let different = 0;
  for (let i = 0; i < a.length; i += 4) {
    different += Math.max(Math.abs(a[i] - b[i]), Math.abs(a[i + 1] - b[i + 1]), Math.abs(a[i + 2] - b[i + 2])) > 16;
  }
  return different < 0.002 * (a.length / 4);
}

/** How many pixels of the view have which colour. */
async function colours(page) {
  const data = await pixels(page, await picture(page));
  const counts = {};
  for (let i = 0; i < data.length; i += 4) {
    const key = `${data[i]},${data[i + 1]},${data[i + 2]}`;
    counts[key] = (counts[key] ?? 0) + 1;
  }
  return counts;
}

const run = () => write('run', samples.run());

test('the view is not blank, and nothing is asked for but the page', async () => {
  await onPage(run(), async (page) => {
    const counts = await colours(page);
    assert.ok(Object.keys(counts).length > 50, `only ${Object.keys(counts).length} colours`);
    assert.ok((await page.$$('.chart')).length >= 8);
  });
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

test('the numbers one asks for first are on top, and the summary is a table', async () => {
  await onPage(run(), async (page) => {
    assert.match(await page.textContent('.headline'), /methoddynamic-icp.*scans24.*RTE6\.67 mm.*RRE0\.00200°.*status\d+ ok\d+ degenerate\d+ lost/s);
    await page.click('.tabs >> text=Summary');
    assert.deepEqual(await page.$$eval('.measures tr', (rows) => rows.map((row) => row.textContent)), ['RMSE', 'RTE6.67 mm', 'RRE0.00200°']);
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

test('a page of a newer schema keeps what it shows without the viewer', async () => {
  const address = write('newer', samples.run());
  const file = join(own.folder, 'newer.html');
  writeFileSync(file, pageOf(samples.run(), own.viewer).replace('"schema":1', '"schema":2'));
  const { page } = await openPage(own.browser, address);
  assert.match(await page.textContent('#app'), /did not start: .*schema 2.*Without JavaScript this page shows its numbers/s);
  await page.context().close();
});
