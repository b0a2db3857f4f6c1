// Colour, camera, layers and point size: the line over the view.
import { colourings } from '../colour/colourings.js';
import { button, chooser, element } from '../dom.js';
import { layersOf, toggled } from '../layers.js';
import { runAt } from '../session.js';

export const CAMERAS = [
  { id: 'follow', name: 'Follow', help: 'Camera behind the sensor, goes and turns with it (F)' },
  { id: 'free', name: 'Free', help: 'Camera stays where it is put (V)' },
  { id: 'top', name: 'Top', help: 'Seen from above without perspective, with axes in metres; goes with the sensor (C)' },
];

export const SIZE = { least: 1, most: 8, step: 0.5 };

function layerMenu(report, store) {
  const list = element('div', { class: 'menu-body' });
  const menu = element('details', { class: 'menu' }, element('summary', { text: 'Layers', title: 'What is shown' }), list);
  store.watch(['run', 'layers'], (state) => {
    const focused = document.activeElement?.dataset?.layer;
    list.replaceChildren(...layersOf(report, runAt(report, state)).map(({ id, name, key }) =>
      element('label', {},
        element('input', {
          type: 'checkbox', checked: state.layers.has(id), data: { layer: id },
          on: { change: () => store.set({ layers: toggled(store.state.layers, id) }) },
        }), element('span', { text: name }), element('kbd', { text: key.toUpperCase() }))));
    if (focused) list.querySelector(`[data-layer="${focused}"]`)?.focus();
  });
  document.addEventListener('pointerdown', (event) => { if (!menu.contains(event.target)) menu.open = false; });
  return menu;
}

export function createToolbar(report, store, view) {
  const colour = chooser('Colour of the points', colourings.map(({ id, name }) => ({ value: id, text: name })),
    (value) => store.set({ colour: value, limit: null }));
  const cameras = CAMERAS.map(({ id, name, help }) => button(name, `${name}: ${help}`, () => store.set({ camera: id }), { data: { camera: id } }));
  const size = element('input', {
    type: 'range', min: SIZE.least, max: SIZE.most, step: SIZE.step, 'aria-label': 'Point size in pixels', title: 'Point size (+ and −)',
    on: { input: () => store.set({ size: Number(size.value) }) },
  });
  store.watch(['colour'], (state) => colour.set(state.colour));
  store.watch(['size'], (state) => { size.value = String(state.size); });
  store.watch(['camera'], (state) => {
    cameras.forEach((entry, k) => entry.setAttribute('aria-pressed', String(CAMERAS[k].id === state.camera)));
  });
  const ruler = button('Ruler', 'Ruler: click two places of the view (L)', () => store.set({ measuring: !store.state.measuring, ruler: [] }));
  store.watch(['measuring'], ({ measuring }) => ruler.setAttribute('aria-pressed', String(measuring)));
  const noScans = report.runs.every((run) => run.scans === null);
  return element('div', { class: 'toolbar', role: 'toolbar', 'aria-label': 'View' },
    element('label', { class: 'field', hidden: noScans }, element('span', { text: 'Colour' }), colour.element),
    element('div', { class: 'segments', role: 'group', 'aria-label': 'Camera' }, ...cameras),
    button('Reset', 'Reset camera (R)', () => view.resetCamera()),
    layerMenu(report, store), ruler, button('PNG', 'Save the view as PNG (Shift P)', () => view.savePicture()),
    element('label', { class: 'field size', hidden: noScans && report.runs.every((run) => run.map === null) }, element('span', { text: 'Points' }), size));
}
