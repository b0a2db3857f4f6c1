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

async function bytesOf(id) {
  const holder = document.getElementById(id);
  if (!holder) throw new Error(`The page has no element '${id}'.`);
  return inflate(decodeBase64(holder.textContent));
}

/** Kept scan `place` of a run. @returns {Promise<import('./bytes.js').Scan>} */
export const readScan = async (run, place) => decodeScan(await bytesOf(`scan-${run}-${place}`));

/** A map of a run: 'map' of what is static, 'traces' of what moves. */
export const readMap = async (name, run) => decodeMap(await bytesOf(`${name}-${run}`));
