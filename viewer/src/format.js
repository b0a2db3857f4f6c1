// Numbers as people read them.

/** `digits` significant digits without trailing zeros; large numbers in full; "–" for what does not exist. */
export function shortNumber(value, digits = 3) {
  if (value === null || value === undefined || !Number.isFinite(value)) return '–';
  if (value === 0) return '0';
  const size = Math.abs(value);
  if (size >= 1e6 || size < 1e-4) return value.toExponential(digits - 1).replace(/\.?0+e/, 'e').replace('e+', 'e');
  const decimals = Math.max(0, digits - 1 - Math.floor(Math.log10(size)));
  const text = value.toFixed(decimals);
  return (decimals > 0 ? text.replace(/\.?0+$/, '') : text).replace('-', '−');
}

export const withUnit = (value, unit, digits = 3) =>
  `${shortNumber(value, digits)}${unit && value !== null ? `${unit === '°' ? '' : ' '}${unit}` : ''}`;

/** A whole number with its thousands apart. What the browser has for that takes 15 ms to begin. */
export const grouped = (count) => String(count).replace(/\B(?=(\d{3})+$)/g, ',');

/** @param {number} count */
export const counted = (count, one, many = `${one}s`) => `${grouped(count)} ${count === 1 ? one : many}`;
