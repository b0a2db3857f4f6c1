// Accessibility of the page by axe-core: names, roles, contrast, in both themes. Skipped with 77 where a browser or axe is
// missing.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import test from 'node:test';
import { findBrowser, openPage, skipIfMissing } from './browser.mjs';
import { pageFiles } from './page_files.mjs';
import { samples } from './sample_page.mjs';
import { whole } from './use_page.mjs';

const found = await findBrowser();
skipIfMissing(found);
let axe;
try {
  axe = readFileSync(createRequire(import.meta.url).resolve('axe-core/axe.min.js'), 'utf8');
} catch {
  skipIfMissing({ missing: 'axe-core is not installed (scripts/install_viewer.sh tests)' });
}

const own = pageFiles('access', found.launch);

/** What axe finds wrong by WCAG 2.1 A and AA, as texts. */
async function violations(page) {
  await page.evaluate(axe);
  const { violations: found_ } = await page.evaluate(() => window.axe.run(document, { runOnly: ['wcag2a', 'wcag2aa', 'wcag21a', 'wcag21aa'] }));
  return found_.flatMap(({ id, nodes }) => nodes.map(({ target, failureSummary }) => `${id}: ${target} ${failureSummary.replace(/\s+/g, ' ')}`));
}

for (const kind of Object.keys(samples)) {
  for (const colorScheme of ['light', 'dark']) {
    test(`${kind}, ${colorScheme}: no violation of WCAG 2.1 AA on any sheet`, async () => {
      const { page } = await openPage(own.browser, own.write(kind, samples[kind]()), { colorScheme });
      await whole(page);
      for (const tab of await page.$$('.tabs button')) {
        await tab.click();
        assert.deepEqual(await violations(page), [], await tab.textContent());
      }
      await page.context().close();
    });
  }
}

test('a control without a name is found', async () => {
  const { page } = await openPage(own.browser, own.write('nameless', samples.run()));
  await page.waitForSelector('.play');
  await page.$eval('.play', (button) => { button.removeAttribute('aria-label'); button.removeAttribute('title'); });
  assert.match((await violations(page)).join(' '), /button-name/);
  await page.context().close();
});
