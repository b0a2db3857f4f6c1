// The state in the fragment of the address, so that a link shows what its sender saw.
//   #frame=12&colour=doppler&layers=boxes,ids&camera=free&eye=1,2,3,4,5,6
import { COLOUR_LIMIT, colourings } from './colour/colourings.js';
import { layers } from './layers.js';
import { CAMERAS, SIZE } from './panels/toolbar.js';
import { SPEEDS } from './player.js';

const FARTHEST = 1e6; // m, of a camera from what it goes with

const numberList = (text) => text.split(',').map((entry) => (entry.trim() === '' ? NaN : Number(entry)));
const isEye = (list) => list.length === 6 && list.every((value) => Math.abs(value) <= FARTHEST);

const wholeNumber = {
  write: String,
  read: (text) => (/^\d{1,9}$/.test(text) ? Number(text) : undefined),
};
const numberWithin = ({ least, most }) => ({
  write: (value) => String(Number(value.toPrecision(4))),
  read: (text) => (text !== '' && Number(text) >= least && Number(text) <= most ? Number(text) : undefined),
});
const oneOf = (known) => ({ write: String, read: (text) => known.find((value) => String(value) === text) });
const word = { write: String, read: (text) => (/^[a-z-]{1,30}$/.test(text) ? text : undefined) };
/** Unknown entries are left out; where nothing known is left, nothing was said. No text at all is the empty set. */
const someOf = (known) => ({
  write: (set) => [...set].join(','),
  read: (text) => {
    const found = text.split(',').filter((entry) => known.includes(entry));
    return found.length || text === '' ? new Set(found) : undefined;
  },
});
const wholeNumbers = {
  write: (set) => [...set].join(','),
  read: (text) => new Set(text.split(',').filter((entry) => /^\d{1,6}$/.test(entry)).map(Number)),
};
/** Two ascending numbers. */
const span = {
  write: (list) => list.map((value) => Number(value.toPrecision(6))).join(','),
  read: (text) => {
    const list = numberList(text);
    return list.length === 2 && list.every(Number.isFinite) && list[0] < list[1] ? list : undefined;
  },
};
const words = {
  write: (set) => [...set].join(','),
  read: (text) => new Set(text.split(',').filter((entry) => /^[a-z_-]{1,40}$/.test(entry))),
};
const flag = { write: (value) => (value ? '1' : '0'), read: (text) => (/^[01]$/.test(text) ? text === '1' : undefined) };
const eye = {
  write: (list) => list.map((value) => Number(value.toFixed(3))).join(','),
  read: (text) => (isEye(numberList(text)) ? numberList(text) : undefined),
};

/** What is kept in the fragment: key -> how. */
const kept = {
  group: wholeNumber,
  run: wholeNumber,
  frame: wholeNumber,
  colour: oneOf(colourings.map(({ id }) => id)),
  limit: numberWithin(COLOUR_LIMIT),
  layers: someOf(layers.map(({ id }) => id)),
  camera: oneOf(CAMERAS.map(({ id }) => id)),
  eye,
  size: numberWithin(SIZE),
  speed: oneOf(SPEEDS),
  tab: word, // sheets differ from page to page: tabs.js shows the first for one it has not
  hidden: wholeNumbers,
  object: wholeNumber,
  chase: flag,
  zoom: span, // of the plots
  folded: words, // plots
  theme: oneOf(['light', 'dark']),
};

export const keptKeys = Object.keys(kept);

/** @param {string} fragment with or without '#'. What cannot be read, is unknown or out of range is left out. */
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
