// A picture of a page as a reader sees it: node test/take_picture.mjs PAGE.html OUT.png [FRAGMENT] [WIDTH] [HEIGHT]
import { resolve } from 'node:path';
import { pathToFileURL } from 'node:url';
import { findBrowser, openPage } from './browser.mjs';

const [file, out, fragment = '', width = 1600, height = 1000] = process.argv.slice(2);
const found = await findBrowser();
if (found.missing) throw new Error(found.missing);
const browser = await found.launch();
try {
  const viewport = { width: Number(width), height: Number(height) };
  const { page } = await openPage(browser, `${pathToFileURL(resolve(file)).href}#${fragment}`, { viewport });
  await page.waitForSelector('.scene-holder[data-frame]');
  await page.waitForFunction(() => !document.querySelector('[aria-busy]')); // what is made after the first picture
  await page.waitForTimeout(1500); // all points are drawn once nothing moves
  await page.screenshot({ path: out });
} finally {
  await browser.close();
}
