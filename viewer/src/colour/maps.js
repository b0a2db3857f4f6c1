// Colours that people with any colour vision tell apart, on light and on dark ground.

const stops = {
  // Two-sided: blue comes closer, orange to red goes away, grey stands.
  diverging: {
    light: ['#08409c', '#3e80d2', '#a3a9b2', '#e46842', '#aa1414'],
    dark: ['#69c8ff', '#4092dc', '#525965', '#de683e', '#ff9e5c'],
  },
  // One-sided, evenly brighter: from dark violet to yellow.
  sequential: {
    light: ['#2a1a5e', '#2d5f8a', '#2a9d80', '#8cc152', '#e8c938'],
    dark: ['#4a3a9c', '#3a7fb5', '#2fb391', '#a6d75b', '#fdf6c0'],
  },
};

/** Of runs and series, the same as `categorical_colours` of the pictures: a method has one colour everywhere. */
const categories = {
  light: ['#0072b2', '#b83a00', '#009e73', '#d99400', '#cc79a7', '#4aa3d8', '#6b4fa0', '#555555'],
  dark: ['#56b4e9', '#ff8f4a', '#2fc79a', '#f0c419', '#e79cc4', '#9fd3f5', '#b39ddb', '#c9ced6'],
};

/** Of objects by their ids: none is close to one of the marks that stand beside them (test/colour.test.mjs). */
const ids = {
  light: ['#00088f', '#ba66e9', '#62740d', '#5d1950', '#5f3cc5', '#1e3603'],
  dark: ['#7ab9ff', '#c65802', '#51b153', '#fbcefe', '#9257e0', '#79ffb2'],
};

/** What the legend names by a colour of its own, told apart by shape as well. Nothing else has these colours. */
const marks = {
  light: {
    measured: '#d1350f', predicted: '#008a63', unknown: '#c3c8d0', unused: '#d5d9e0', still: '#8d96a3', moving: '#d99400',
    selected: '#c2007a', box: '#3b4554',
  },
  dark: {
    measured: '#ff6b4a', predicted: '#35d6a6', unknown: '#3b4452', unused: '#2c3542', still: '#77828f', moving: '#f0c419',
    selected: '#ff5fb8', box: '#d3dae4',
  },
};

/** @typedef {'light'|'dark'} Ground */

/** @param {string} hex #rrggbb @returns {[number, number, number]} 0 to 255 */
export const rgb = (hex) => [1, 3, 5].map((at) => parseInt(hex.slice(at, at + 2), 16));

/** The colour of a map at 0 to 1; outside it is the end. @param {Ground} ground */
export function mapColour(map, ground, share) {
  const list = stops[map][ground];
  const place = Math.min(1, Math.max(0, share)) * (list.length - 1);
  const below = Math.min(list.length - 2, Math.floor(place));
  const low = rgb(list[below]);
  const high = rgb(list[below + 1]);
  return low.map((value, k) => Math.round(value + (high[k] - value) * (place - below)));
}

/** 256 colours as RGBA bytes, for a texture. */
export function lookupTable(map, ground) {
  const table = new Uint8Array(4 * 256);
  for (let k = 0; k < 256; ++k) table.set([...mapColour(map, ground, k / 255), 255], 4 * k);
  return table;
}

/** Colours of runs and series; after eight they begin again. */
export const categoryColour = (k, ground) => categories[ground][k % categories[ground].length];

export const CATEGORY_COUNT = categories.light.length;

export const ID_COLOURS = ids.light.length;
/** Which colour an object has: by its id, so that it stays the same from scan to scan. */
export const idColourIndex = (id) => ((Math.trunc(id) % ID_COLOURS) + ID_COLOURS) % ID_COLOURS;
/** @param {number} k see `idColourIndex` @param {Ground} ground */
export const idColour = (k, ground) => ids[ground][k];

/** @param {Ground} ground */
export const markColours = (ground) => marks[ground];

/** The colours a map goes through, evenly spaced. */
export const mapStops = (map, ground) => stops[map][ground];

/** As a CSS gradient, from left to right. */
export const gradient = (map, ground) => `linear-gradient(to right, ${stops[map][ground].join(', ')})`;
