// Scans are decoded when they are wanted; the last ones stay.

/**
 * @template T
 * @param {(run: number, place: number) => Promise<T>} read
 * @param {number} capacity how many stay
 */
export function createScanCache(read, capacity) {
  const kept = new Map(); // in the order of use, the oldest first
  return {
    /** @returns {Promise<T>} */
    get(run, place) {
      const key = `${run}/${place}`;
      const scan = kept.get(key) ?? read(run, place);
      kept.delete(key);
      kept.set(key, scan);
      while (kept.size > capacity) kept.delete(kept.keys().next().value);
      return scan;
    },
  };
}
