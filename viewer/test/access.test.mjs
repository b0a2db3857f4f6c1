// Accessibility of the page by axe-core: names, roles, contrast, in both themes. Skipped with 77 where a browser or axe is
// missing.
import assert from 'node:assert/strict';
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import test, { after, before } from 'node:test';
import { pathToFileURL } from 'node:url';
import { bundle } from '../build.mjs';
import { findBrowser, openPage, skipIfMissing } from './browser.mjs';
import { pageOf, samples } from './sample_page.mjs';

const found = await findBrowser();
skipIfMissing(found);
let axe;
try {
  axe = readFileSync(createRequire(import.meta.url).resolve('axe-core/axe.min.js'), 'utf8');
} catch {
  skipIfMissing({ missing: 'axe-core is not installed (scripts/install_viewer.sh tests)' });
}

const folder = mkdtempSync(join(tmpdir(), 'viewer-access-'));
let browser;
let viewer;
before(async () => {
  viewer = await bundle();
  browser = await found.launch();
});
after(async () => {
  await browser?.close();
  rmSync(folder, { recursive: true, force: true });
});

/** What axe finds wrong by WCAG 2.1 A and AA, as texts. */
async function violations(page) {
  await page.evaluate(axe);
  const { violations: found_ } = await page.evaluate(() => window.axe.run(document, { runOnly: ['wcag2a', 'wcag2aa', 'wcag21a', 'wcag21aa'] }));
  return found_.flatMap(({ id, nodes }) => nodes.map(({ target, failureSummary }) => `${id}: ${target} ${failureSummary.replace(/\s+/g, ' ')}`));
}

for (const kind of Object.keys(samples)) {
  for (const colorScheme of ['light', 'dark']) {
    test(`${kind}, ${colorScheme}: no violation of WCAG 2.1 AA on any sheet`, async () => {
      const file = join(folder, `${kind}.html`);
      writeFileSync(file, pageOf(samples[kind](), viewer));
      const { page } = await openPage(browser, pathToFileURL(file).href, { colorScheme });
      await page.waitForSelector('.scene-holder[data-frame]');
      for (const tab of await page.$$('.tabs button')) {
        await tab.click();
        assert.deepEqual(await violations(page), [], await tab.textContent());
      }
      await page.context().close();
    });
  }
}

test('a control without a name is found', async () => {
  const file = join(folder, 'nameless.html');
  writeFileSync(file, pageOf(samples.run(), viewer));
  const { page } = await openPage(browser, pathToFileURL(file).href);
  await page.waitForSelector('.play');
  await page.$eval('.play', (button) => { button.removeAttribute('aria-label'); button.removeAttribute('title'); });
  assert.match((await violations(page)).join(' '), /button-name/);
  await page.context().close();
});
