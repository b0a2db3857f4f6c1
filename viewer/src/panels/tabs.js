// The panel beside the view: one sheet at a time.
import { element } from '../dom.js';

/**
 * @param {{id: string, name: string, element: HTMLElement}[]} sheets
 */
export function createTabs(store, sheets) {
  const buttons = sheets.map(({ id, name }) => element('button', {
    type: 'button', role: 'tab', id: `tab-${id}`, 'aria-controls': `sheet-${id}`, text: name,
    on: {
      click: () => store.set({ tab: id }),
      keydown: (event) => {
        const step = { ArrowRight: 1, ArrowLeft: -1 }[event.key];
        if (!step) return;
        event.stopPropagation();
        const at = sheets.findIndex((sheet) => sheet.id === store.state.tab);
        const next = sheets[(at + step + sheets.length) % sheets.length].id;
        store.set({ tab: next });
        buttons[sheets.findIndex((sheet) => sheet.id === next)].focus();
      },
    },
  }));
  for (const { id, element: sheet } of sheets) {
    sheet.classList.add('sheet');
    sheet.id = `sheet-${id}`;
    sheet.setAttribute('role', 'tabpanel');
    sheet.setAttribute('aria-labelledby', `tab-${id}`);
  }
  store.watch(['tab'], (state) => {
    const chosen = sheets.some(({ id }) => id === state.tab) ? state.tab : sheets[0].id;
    sheets.forEach(({ id, element: sheet }, k) => {
      sheet.hidden = id !== chosen;
      buttons[k].setAttribute('aria-selected', String(id === chosen));
      buttons[k].tabIndex = id === chosen ? 0 : -1;
    });
  });
  return element('section', { class: 'side', 'aria-label': 'Results' },
    element('div', { class: 'tabs', role: 'tablist' }, ...buttons), ...sheets.map((sheet) => sheet.element));
}
