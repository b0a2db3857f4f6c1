// What was told of the last scans, for plots over time: columns that grow at the end and are cut at the beginning.

export const KEPT_SECONDS = 60;

const NAMES = ['seconds', 'status', 'speed', 'speedSigma', 'positionSigma', 'rotationSigma', 'points', 'used', 'objects', 'time', 'error', 'latency'];

/** @typedef {Record<string, any[]>} History columns by name; `seconds` since the first scan that was seen */

/** @returns {History} */
export const createHistory = () => Object.fromEntries(NAMES.map((name) => [name, []]));

/** @param {History} history @param {object} state of a scan, see `decodeState` */
export function append(history, seconds, state) {
  if (seconds <= history.seconds.at(-1)) return; // it was there before a connection was lost
  for (const name of NAMES) history[name].push(name === 'seconds' ? seconds : state[name]);
  let old = 0;
  while (history.seconds[old] < seconds - KEPT_SECONDS) ++old;
  if (old > 0) for (const name of NAMES) history[name].splice(0, old);
}

export function clear(history) {
  for (const name of NAMES) history[name].length = 0;
}

/** Stretches of equal status that is neither good nor the first. */
export function troubles({ seconds, status }) {
  const ranges = [];
  status.forEach((word, k) => {
    if (word !== 'degenerate' && word !== 'lost') return;
    const last = ranges.at(-1);
    const from = k > 0 ? 0.5 * (seconds[k - 1] + seconds[k]) : seconds[k];
    if (last && last.status === word && last.until === k - 1) Object.assign(last, { to: seconds[k], until: k });
    else ranges.push({ status: word, from, to: seconds[k], until: k });
  });
  return ranges;
}
