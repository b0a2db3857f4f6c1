// Bundles the viewer: node build.mjs [--output FOLDER] [--cpp FILE.cpp]
//   FOLDER gets viewer.js and viewer.css; FILE.cpp gets both, and those of the live page, as the C++ source behind
//   report/viewer_bundle.hpp.
// Needs nothing but what `npm ci` put into node_modules.
import { mkdir, writeFile } from 'node:fs/promises';
import { dirname, join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { build } from 'esbuild';
import { cppSource } from './cpp_source.mjs';

const here = dirname(fileURLToPath(import.meta.url));

/**
 * @param {string} [entry] of the page of a run; 'live/main.js' is that of the live page
 * @returns {Promise<{script: string, style: string}>}
 */
export async function bundle(entry = 'main.js') {
  const { outputFiles } = await build({
    entryPoints: [join(here, 'src', entry)],
    bundle: true,
    minify: true,
    write: false,
    outdir: here,
    format: 'iife',
    target: ['es2022', 'chrome100', 'firefox113', 'safari16.4'],
    legalComments: 'inline', // the licence of three.js goes with its code
    charset: 'ascii',
    logLevel: 'warning',
  });
  const text = (end) => outputFiles.find(({ path }) => path.endsWith(end)).text;
  const script = text('.js');
  const style = text('.css');
  if (/<\/script/i.test(script) || /<!--/.test(script) || /<\/style/i.test(style)) {
    throw new Error('the bundle holds a mark that would end its element in a page');
  }
  return { script, style };
}

async function main(args) {
  const option = (name) => (args.includes(name) ? args[args.indexOf(name) + 1] : null);
  const made = await bundle();
  const folder = option('--output');
  const cpp = option('--cpp');
  if (folder) {
    await mkdir(folder, { recursive: true });
    await writeFile(join(folder, 'viewer.js'), made.script);
    await writeFile(join(folder, 'viewer.css'), made.style);
  }
  if (cpp) await writeFile(cpp, cppSource({ viewer_bundle: made, live_bundle: await bundle('live/main.js') }));
  if (!folder && !cpp) console.log(`script ${made.script.length} bytes, style ${made.style.length} bytes`);
}

if (process.argv[1] === fileURLToPath(import.meta.url)) await main(process.argv.slice(2));
