// Light and dark: as the system says, or as chosen here.

/** @returns {import('./colour/maps.js').Ground} */
export const groundOf = (state) => state.theme ?? state.systemTheme;

/** Keeps the document in step with the state and the state in step with the system. */
export function followTheme(store) {
  const dark = matchMedia('(prefers-color-scheme: dark)');
  const system = () => store.set({ systemTheme: dark.matches ? 'dark' : 'light' });
  dark.addEventListener('change', system);
  system();
  store.watch(['theme', 'systemTheme'], (state) => { document.documentElement.dataset.theme = groundOf(state); });
}

export const otherTheme = (state) => (groundOf(state) === 'dark' ? 'light' : 'dark');

const known = new Map(); // colours by theme and name: asking the browser makes it style the page at once

/** A colour of the style sheet: '#rrggbb', or three numbers from 0 to 1. */
export function cssColour(name, asNumbers = false) {
  const root = document.documentElement;
  const key = `${root.dataset.theme} ${name}`;
  if (!known.has(key)) known.set(key, getComputedStyle(root).getPropertyValue(name).trim());
  const text = known.get(key);
  return asNumbers ? [1, 3, 5].map((at) => parseInt(text.slice(at, at + 2), 16) / 255) : text;
}
