// What a test file of pages needs, from before its first test to after its last.
import { mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before } from 'node:test';
import { pathToFileURL } from 'node:url';
import { bundle } from '../build.mjs';
import { pageOf } from './sample_page.mjs';

/** A browser, the viewer, and a folder of its own. `write` gives the address of a page with this content. */
export function pageFiles(name, launch) {
  const folder = mkdtempSync(join(tmpdir(), `viewer-${name}-`));
  const own = {
    folder, browser: null, viewer: null,
    write(page, content) {
      const file = join(folder, `${page}.html`);
      writeFileSync(file, pageOf(content, own.viewer));
      return pathToFileURL(file).href;
    },
  };
  before(async () => {
    own.viewer = await bundle();
    own.browser = await launch();
  });
  after(async () => {
    await own.browser?.close();
    rmSync(folder, { recursive: true, force: true });
  });
  return own;
}
