// What tests of a page in the browser share: opening it, waiting for it, and comparing its pictures.
import assert from 'node:assert/strict';
import { openPage } from './browser.mjs';
import { pageFiles } from './page_files.mjs';
import { samples } from './sample_page.mjs';

/** Pages of one test file. @param {string} name of the file @param {{launch: Function}} found a browser, see browser.mjs */
export function browserPages(name, found) {
  const own = pageFiles(name, found.launch);
  return {
    own,
    write: own.write,
    run: () => own.write('run', samples.run()),
    /** Opens a page, lets `act` use it, and fails when the page wrote an error or asked for anything. */
    async onPage(address, act, options = {}) {
      const { page, troubles } = await openPage(options.browser ?? own.browser, address, options.context);
      try {
        await whole(page);
        await act(page);
        assert.deepEqual(troubles, []);
      } finally {
        await page.context().close();
      }
    },
  };
}

/** Waits for the first picture and for what is made after it. */
export async function whole(page) {
  await page.waitForSelector('.scene-holder[data-frame]');
  await page.waitForFunction(() => !document.querySelector('[aria-busy]'));
}

export const frameOf = (page) => page.$eval('.scene-holder', (holder) => Number(holder.dataset.frame));
export const shown = (page, frame) => page.waitForSelector(`.scene-holder[data-frame="${frame}"]`);

// What lies over the view is no part of its picture.
const SCENE_ONLY = '.status, .legend, .point-reading, .menu-body, .labels { visibility: hidden } .scene { outline: none !important }';

/** Waits until nothing is drawn any more, then gives the picture of the view. */
export async function picture(page) {
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
export async function pixels(page, image) {
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
export async function isSame(page, one, other) {
  const [a, b] = [await pixels(page, one), await pixels(page, other)];
  assert.equal(a.length, b.length);
  let different = 0;
  for (let i = 0; i < a.length; i += 4) {
    different += Math.max(Math.abs(a[i] - b[i]), Math.abs(a[i + 1] - b[i + 1]), Math.abs(a[i + 2] - b[i + 2])) > 16;
  }
  return different < 0.002 * (a.length / 4);
}

/** How many pixels of the view have which colour. */
export async function colours(page) {
  const data = await pixels(page, await picture(page));
  const counts = {};
  for (let i = 0; i < data.length; i += 4) {
    const key = `${data[i]},${data[i + 1]},${data[i + 2]}`;
    counts[key] = (counts[key] ?? 0) + 1;
  }
  return counts;
}
