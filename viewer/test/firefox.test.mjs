// The pages in Debian's Firefox as it is. Skipped with 77 where it is missing. Without a screen it offers no WebGL: the page
// then has to do with the plan.
import assert from 'node:assert/strict';
import test from 'node:test';
import { findFirefox, openPage, skipIfMissing } from './browser.mjs';
import { pageFiles } from './page_files.mjs';
import { samples } from './sample_page.mjs';

const found = await findFirefox();
skipIfMissing(found);

const own = pageFiles('firefox', found.launch);

for (const kind of Object.keys(samples)) {
  test(`${kind}: shows every sheet, steps and plays, and the legend lies over no note`, async () => {
    const { page, troubles } = await openPage(own.browser, `${own.write(kind, samples[kind]())}#frame=3`);
    await page.waitForSelector('.scene-holder[data-frame="3"]');
    await page.keyboard.press('ArrowRight');
    await page.waitForSelector('.scene-holder[data-frame="4"]');
    for (const tab of await page.$$('.tabs button')) {
      await tab.click();
      assert.equal(await tab.getAttribute('aria-selected'), 'true');
      // Charts have no text before Firefox has drawn them once (content-visibility).
      await page.waitForFunction(() => [...document.querySelectorAll('.sheet')].find((sheet) => !sheet.hidden).innerText.length > 20);
    }
    await page.click('.play');
    await page.waitForFunction(() => Number(document.querySelector('.scene-holder').dataset.frame) > 6);
    const note = page.locator('.scene-note');
    if (await note.count() > 0) {
      assert.equal(await page.isVisible('.legend'), false);
      assert.ok(await note.isVisible());
    } else {
      assert.ok(Number(await page.getAttribute('.scene-holder', 'data-draws')) > 3);
    }
    const wider = await page.evaluate(() => document.documentElement.scrollWidth - document.documentElement.clientWidth);
    assert.equal(wider, 0);
    assert.deepEqual(troubles, []);
    await page.context().close();
  });
}
