// The overlay that lists the keys.
import { button, element } from '../dom.js';

/** @param {ReturnType<import('../keys.js').keyBindings>} groups */
export function createHelp(groups) {
  const dialog = element('dialog', { class: 'help', 'aria-label': 'Keys and hints' },
    element('div', { class: 'help-top' }, element('h2', { text: 'Keys' }), button('Close', 'Close (Esc)', () => dialog.close())),
    element('div', { class: 'help-groups' }, ...groups.map(({ title, bindings }) =>
      element('section', {}, element('h3', { text: title }), element('dl', {}, ...bindings.flatMap(({ shown, meaning }) => [
        element('dt', {}, ...shown.split(' ').map((key) => element('kbd', { text: key }))), element('dd', { text: meaning }),
      ]))))),
    element('p', { class: 'muted', text: 'View: drag turns, right drag or two fingers move, wheel or pinch zooms; a click on a point tells what is known of it. Plots: a click or drag goes to that frame. The address holds the state of the page: “Copy link” shares it.' }));
  dialog.addEventListener('click', (event) => { if (event.target === dialog) dialog.close(); });
  return dialog;
}
