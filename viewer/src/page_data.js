// What the page holds, read from its elements (docs/report.md).
import { decodeBase64, decodeMap, decodeScan, inflate } from './bytes.js';

const SCHEMA = 1;

/** The JSON of the page. Throws an Error with a text for the reader. */
export function readReport() {
  const holder = document.getElementById('report');
  if (!holder) throw new Error('This page holds no report.');
  const report = JSON.parse(holder.textContent);
  if (report.schema !== SCHEMA) {
    throw new Error(`This page was written for a viewer of schema ${report.schema}; this one reads ${SCHEMA}.`);
  }
  return report;
}

/** The viewer runs while the page is still being read: then what follows it is waited for. */
const isRead = new Promise((done) => {
  if (document.readyState === 'loading') document.addEventListener('DOMContentLoaded', done, { once: true });
  else done();
});

/** Whether an element stands there to its end: something follows it. */
const isWhole = (holder) => holder !== null && holder.nextSibling !== null;

async function bytesOf(id) {
  if (!isWhole(document.getElementById(id))) await isRead;
  const holder = document.getElementById(id);
  if (!holder) throw new Error(`The page has no element '${id}'.`);
  return inflate(decodeBase64(holder.textContent));
}

/** Kept scan `place` of a run. @returns {Promise<import('./bytes.js').Scan>} */
export const readScan = async (run, place) => decodeScan(await bytesOf(`scan-${run}-${place}`));

/** A map of a run: 'map' of what is static, 'traces' of what moves. */
export const readMap = async (name, run) => decodeMap(await bytesOf(`${name}-${run}`));
