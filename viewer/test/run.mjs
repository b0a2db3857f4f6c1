// Runs one file of tests for CTest: node run.mjs NAME. Status 77 (skipped) where the viewer's packages are missing.
import { createRequire } from 'node:module';

const require = createRequire(import.meta.url);
for (const name of ['three', 'esbuild']) {
  try {
    require.resolve(name);
  } catch {
    console.log(`skipped: ${name} is not installed (scripts/install_viewer.sh tests)`);
    process.exit(77);
  }
}
await import(`./${process.argv[2]}.test.mjs`);
