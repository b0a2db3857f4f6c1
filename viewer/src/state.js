// The state in the fragment of the address, so that a link shows what its sender saw.
//   #frame=12&colour=doppler&layers=boxes,ids&camera=free&eye=1,2,3,4,5,6

const numberList = (text) => text.split(',').map(Number);
const isNumbers = (list, length) => list.length === length && list.every(Number.isFinite);

const wholeNumber = {
  write: String,
  read: (text) => (/^\d{1,9}$/.test(text) ? Number(text) : undefined),
};
const number = {
  write: (value) => String(Number(value.toPrecision(4))),
  read: (text) => (text !== '' && Number.isFinite(Number(text)) ? Number(text) : undefined),
};
const word = { write: String, read: (text) => (/^[a-z-]{1,30}$/.test(text) ? text : undefined) };
const words = {
  write: (set) => [...set].join(','),
  read: (text) => new Set(text.split(',').filter((entry) => /^[a-z-]{1,30}$/.test(entry))),
};
const wholeNumbers = {
  write: (set) => [...set].join(','),
  read: (text) => new Set(text.split(',').filter((entry) => /^\d{1,6}$/.test(entry)).map(Number)),
};
const eye = {
  write: (list) => list.map((value) => Number(value.toFixed(3))).join(','),
  read: (text) => (isNumbers(numberList(text), 6) ? numberList(text) : undefined),
};

/** What is kept in the fragment: key -> how. */
const kept = {
  group: wholeNumber,
  run: wholeNumber,
  frame: wholeNumber,
  colour: word,
  limit: number,
  layers: words,
  camera: word,
  eye,
  size: number,
  speed: number,
  tab: word,
  hidden: wholeNumbers,
  theme: word,
};

export const keptKeys = Object.keys(kept);

/** @param {string} fragment with or without '#'. What cannot be read is left out. */
export function readFragment(fragment) {
  const state = {};
  for (const [key, text] of new URLSearchParams(fragment.replace(/^#/, ''))) {
    const value = Object.hasOwn(kept, key) ? kept[key].read(text) : undefined;
    if (value !== undefined) state[key] = value;
  }
  return state;
}

/** What differs from the defaults, as a fragment without '#'. */
export function writeFragment(state, defaults) {
  const parts = [];
  for (const [key, { write }] of Object.entries(kept)) {
    if (state[key] === null || state[key] === undefined) continue;
    const text = write(state[key]);
    const usual = defaults[key] === null || defaults[key] === undefined ? null : write(defaults[key]);
    if (key === 'frame' || text !== usual) parts.push(`${key}=${encodeURIComponent(text).replaceAll('%2C', ',')}`);
  }
  return parts.join('&');
}
