// Headless browsers for the tests, or the reason why there are none.
import { existsSync } from 'node:fs';

const CHROMIUM = ['/usr/bin/chromium', '/usr/bin/chromium-browser', '/usr/bin/google-chrome'];
const FIREFOX = ['/usr/bin/firefox-esr', '/usr/bin/firefox'];

/** @returns {Promise<{executablePath: string, playwright: typeof import('playwright-core')} | {missing: string}>} */
async function find(name, places) {
  const executablePath = places.find((place) => place && existsSync(place));
  if (!executablePath) return { missing: `${name} is not installed (scripts/install_dependencies.sh tests)` };
  try {
    return { executablePath, playwright: await import('playwright-core') };
  } catch {
    return { missing: 'playwright-core is not installed (scripts/install_viewer.sh tests)' };
  }
}

/** @returns {Promise<{launch: (extra?: string[]) => Promise<import('playwright-core').Browser>} | {missing: string}>} */
export async function findBrowser() {
  const { missing, executablePath, playwright } = await find('chromium', [process.env.CHROMIUM, ...CHROMIUM]);
  if (missing) return { missing };
  const software = ['--use-gl=angle', '--use-angle=swiftshader', '--enable-unsafe-swiftshader'];
  return {
    launch: (extra = software) => playwright.chromium.launch({ executablePath, args: ['--no-sandbox', '--disable-dev-shm-usage', ...extra] }),
  };
}

/** An unchanged Firefox, by WebDriver BiDi. */
export async function findFirefox() {
  const { missing, executablePath, playwright } = await find('firefox-esr', [process.env.FIREFOX, ...FIREFOX]);
  if (missing) return { missing };
  const firefoxUserPrefs = { 'webgl.force-enabled': true, 'gfx.x11-egl.force-enabled': true };
  return { launch: () => playwright.firefox.launch({ channel: 'moz-firefox', executablePath, firefoxUserPrefs }) };
}

/** Ends a test file that cannot run: with the status CTest takes for skipped, with success under `node --test`. */
export function skipIfMissing({ missing }) {
  if (!missing) return;
  console.log(`skipped: ${missing}`);
  process.exit(process.env.NODE_TEST_CONTEXT ? 0 : 77);
}

/**
 * A page that fails on its own when it writes an error or asks for anything but itself.
 * @returns {Promise<{page: import('playwright-core').Page, troubles: string[]}>}
 */
export async function openPage(browser, address, options = {}) {
  const context = await browser.newContext({ viewport: { width: 1280, height: 800 }, ...options });
  const page = await context.newPage();
  const troubles = [];
  const own = address.split('#')[0];
  page.on('console', (message) => {
    // Chromium itself remarks on software rendering when pixels are read.
    if (['error', 'warning'].includes(message.type()) && !/GPU stall due to ReadPixels|software WebGL/i.test(message.text())) {
      troubles.push(`${message.type()}: ${message.text()}`);
    }
  });
  page.on('pageerror', (error) => troubles.push(`exception: ${error.message}`));
  page.on('request', (request) => {
    if (request.url().split('#')[0] !== own && !/^(data|blob):/.test(request.url())) troubles.push(`request: ${request.url()}`);
  });
  await page.goto(address);
  return { page, troubles };
}
