// Sample pages to look at: node test/write_samples.mjs FOLDER
import { mkdirSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { bundle } from '../build.mjs';
import { pageOf, samples } from './sample_page.mjs';

const folder = process.argv[2] ?? 'samples';
mkdirSync(folder, { recursive: true });
const viewer = await bundle();
for (const [kind, content] of Object.entries(samples)) {
  const file = join(folder, `${kind}.html`);
  writeFileSync(file, pageOf(content(kind === 'run' ? { frames: 60, points: 8000 } : {}), viewer));
  console.log(file);
}
