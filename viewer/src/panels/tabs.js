// The panel beside the view: one sheet at a time.
import { element } from '../dom.js';

const IDLE_WITHIN = 500; // ms

/** When the browser has nothing better to do, but soon. */
const whenIdle = () => new Promise((done) => {
  if (window.requestIdleCallback) requestIdleCallback(done, { timeout: IDLE_WITHIN });
  else setTimeout(done, 0);
});

/**
 * Sheets are made when they are opened first, or one after the other by `fill`.
 * @param {{id: string, name: string, create: () => HTMLElement}[]} kinds
 * @returns {{element: HTMLElement, fill: () => Promise<void>}} `fill` makes what is not made yet, the opened one first, and
 *   lets the page draw in between
 */
export function createTabs(store, kinds) {
  const sheets = kinds.map(({ id, name, create }) => ({
    id, name, create, element: element('div', { class: 'sheet', id: `sheet-${id}`, role: 'tabpanel', 'aria-labelledby': `tab-${id}`, 'aria-busy': 'true' }),
  }));
  let filling = false; // before the first picture nothing is made
  const make = ({ element: sheet, create }) => {
    if (!sheet.hasAttribute('aria-busy')) return;
    sheet.removeAttribute('aria-busy');
    sheet.append(create());
  };
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
  const opened = () => sheets.find(({ id }) => id === store.state.tab) ?? sheets[0];
  store.watch(['tab'], () => {
    const { id: chosen } = opened();
    if (filling) make(opened());
    sheets.forEach(({ id, element: sheet }, k) => {
      sheet.hidden = id !== chosen;
      buttons[k].setAttribute('aria-selected', String(id === chosen));
      buttons[k].tabIndex = id === chosen ? 0 : -1;
    });
  });
  return {
    element: element('section', { class: 'side', 'aria-label': 'Results' },
      element('div', { class: 'tabs', role: 'tablist' }, ...buttons), ...sheets.map((sheet) => sheet.element)),
    async fill() {
      filling = true;
      make(opened());
      for (const sheet of sheets) {
        await whenIdle();
        make(sheet);
      }
    },
  };
}
