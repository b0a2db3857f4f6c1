// The keyboard: every key, what it does, and where the help overlay lists it.
import { colourings } from './colour/colourings.js';
import { layers, toggled } from './layers.js';
import { changeLimit } from './panels/legend.js';
import { selectNext, toggleChase } from './panels/objects.js';
import { zoomAbout } from './panels/plots.js';
import { goToTrouble } from './panels/timeline.js';
import { SIZE } from './panels/toolbar.js';
import { otherTheme } from './theme.js';

/**
 * @typedef {{keys: string[], shown: string, meaning: string, act: (event: KeyboardEvent) => void}} Binding
 * @returns {{title: string, bindings: Binding[]}[]}
 */
export function keyBindings(report, store, player, view, showHelp) {
  const { state } = store;
  const resize = (steps) => store.set({ size: Math.min(SIZE.most, Math.max(SIZE.least, state.size + steps * SIZE.step)) });
  const camera = (mode) => () => store.set({ camera: mode });
  return [
    {
      title: 'Timeline',
      bindings: [
        { keys: [' ', 'k'], shown: 'Space', meaning: 'play or pause', act: () => player.toggle() },
        { keys: ['ArrowRight', 'ArrowLeft'], shown: '→ ←', meaning: 'one frame on or back; ten with Shift',
          act: (event) => player.step((event.key === 'ArrowRight' ? 1 : -1) * (event.shiftKey ? 10 : 1)) },
        { keys: ['Home', 'End'], shown: 'Home End', meaning: 'first or last frame', act: (event) => player.goTo(event.key === 'Home' ? 0 : player.last()) },
        { keys: ['n', 'N'], shown: 'N Shift N', meaning: 'next or last degenerate or lost frame',
          act: (event) => goToTrouble(report, store, player, event.shiftKey ? -1 : 1) },
        { keys: ['>', '.'], shown: '.', meaning: 'play faster', act: () => player.faster(1) },
        { keys: ['<', ','], shown: ',', meaning: 'play slower', act: () => player.faster(-1) },
        { keys: ['z', 'Z'], shown: 'Z Shift Z', meaning: 'plots: a shorter or longer stretch of time',
          act: (event) => zoomAbout(report, store, event.shiftKey ? 0.5 : 2) },
      ],
    },
    {
      title: 'Camera',
      bindings: [
        { keys: ['f'], shown: 'F', meaning: 'follow the sensor', act: camera('follow') },
        { keys: ['v'], shown: 'V', meaning: 'free', act: camera('free') },
        { keys: ['c'], shown: 'C', meaning: 'from above', act: camera('top') },
        { keys: ['r'], shown: 'R', meaning: 'reset camera', act: () => view.resetCamera() },
      ],
    },
    {
      title: 'Objects and lengths',
      bindings: [
        { keys: ['x', 'X'], shown: 'X Shift X', meaning: 'select the next or previous object of the frame, the nearest first',
          act: (event) => selectNext(report, store, event.shiftKey ? -1 : 1) },
        { keys: ['w'], shown: 'W', meaning: 'follow the selected object', act: () => toggleChase(store) },
        { keys: ['l'], shown: 'L', meaning: 'ruler: the distance between two clicks', act: () => store.set({ measuring: !state.measuring, ruler: [] }) },
        { keys: ['Escape'], shown: 'Esc', meaning: 'no ruler; then: select nothing',
          act: () => store.set(state.measuring ? { measuring: false, ruler: [] } : { object: null, chase: false, picked: null }) },
      ],
    },
    {
      title: 'Points',
      bindings: [
        ...colourings.map(({ id, key, name }) => ({ keys: [key], shown: key, meaning: name, act: () => store.set({ colour: id, limit: null }) })),
        { keys: ['[', ']'], shown: '[ ]', meaning: 'narrower or wider range of colours', act: (event) => changeLimit(store, event.key === ']' ? 1 : -1) },
        { keys: ['+', '='], shown: '+', meaning: 'larger points', act: () => resize(1) },
        { keys: ['-', '_'], shown: '−', meaning: 'smaller points', act: () => resize(-1) },
      ],
    },
    {
      title: 'Layers',
      bindings: layers.map(({ id, key, name }) => ({
        keys: [key], shown: key.toUpperCase(), meaning: name, act: () => store.set({ layers: toggled(state.layers, id) }),
      })),
    },
    {
      title: 'Page',
      bindings: [
        { keys: ['P'], shown: 'Shift P', meaning: 'save the view as PNG', act: () => view.savePicture() },
        { keys: ['t'], shown: 'T', meaning: 'toggle theme', act: () => store.set({ theme: otherTheme(state) }) },
        { keys: ['?', 'h'], shown: '?', meaning: 'this list', act: showHelp },
      ],
    },
  ];
}

/** Keys belong to the page unless something is typed or chosen; then they belong to that. */
export function listenToKeys(groups) {
  const acts = new Map(groups.flatMap(({ bindings }) => bindings.flatMap(({ keys, act }) => keys.map((key) => [key, act]))));
  document.addEventListener('keydown', (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey || event.defaultPrevented || document.querySelector('dialog[open]')) return;
    const { target } = event;
    const isText = target.matches?.('input[type=search], input[type=text], textarea, select');
    const isPressed = event.key === ' ' && target.matches?.('button, summary, input[type=checkbox]');
    const isMoved = /^(Arrow|Home|End)/.test(event.key) && target.matches?.('input[type=range]:not(.frames), [role=tab]');
    if (isText || isPressed || isMoved) return;
    const act = acts.get(event.key) ?? acts.get(event.key.toLowerCase());
    if (!act) return;
    event.preventDefault();
    act(event);
  });
}
