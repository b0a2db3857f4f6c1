// The state of the page: one plain object, changed in one place, watched by key.

/**
 * @template {object} T
 * @param {T} initial
 */
export function createStore(initial) {
  const state = { ...initial };
  const watchers = [];
  return {
    /** @type {Readonly<T>} */
    state,
    /** @param {Partial<T>} changes Watchers of keys that really changed are called once. */
    set(changes) {
      const changed = Object.keys(changes).filter((key) => !Object.is(state[key], changes[key]));
      if (changed.length === 0) return;
      Object.assign(state, changes);
      for (const { keys, act } of watchers) {
        if (keys.some((key) => changed.includes(key))) act(state, changed);
      }
    },
    /** Calls `act` now and after every change of one of the keys. */
    watch(keys, act) {
      watchers.push({ keys, act });
      act(state, keys);
    },
  };
}
