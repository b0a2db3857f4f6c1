// Elements without markup: every text of a page is set as text, never parsed.

/**
 * @param {string} tag
 * @param {Record<string, any>} [properties] `text`, `on` (event -> listener), `data` (data-*), the rest are attributes;
 *   null, undefined and false leave an attribute out, true sets it empty
 * @param {...(Node|string|null)} children
 * @returns {HTMLElement}
 */
export function element(tag, properties = {}, ...children) {
  const made = document.createElement(tag);
  for (const [name, value] of Object.entries(properties)) {
    if (name === 'text') {
      made.textContent = value;
    } else if (name === 'on') {
      for (const [event, listener] of Object.entries(value)) made.addEventListener(event, listener);
    } else if (name === 'data') {
      Object.assign(made.dataset, value);
    } else if (value === true) {
      made.setAttribute(name, '');
    } else if (value !== null && value !== undefined && value !== false) {
      made.setAttribute(name, value);
    }
  }
  made.append(...children.filter((child) => child !== null && child !== undefined));
  return made;
}

/**
 * A button that shows an on and an off state; the caller sets `aria-pressed`.
 * @param {string} text
 * @param {string} help shown as a hint and read out
 * @param {() => void} act
 */
export function button(text, help, act, properties = {}) {
  return element('button', { type: 'button', text, title: help, 'aria-label': help, on: { click: act }, ...properties });
}

/**
 * A drop-down list. `set(value)` shows a value without calling `act`.
 * @param {{value: string, text: string}[]} choices
 * @param {(value: string) => void} act
 */
export function chooser(label, choices, act) {
  const list = element('select', { 'aria-label': label, title: label, on: { change: () => act(list.value) } });
  const offer = (entries) =>
    list.replaceChildren(...entries.map(({ value, text }) => element('option', { value, text })));
  offer(choices);
  return { element: list, offer, set: (value) => { list.value = String(value); } };
}

/** A table of [name, value] rows. */
export function pairTable(rows, className = 'pairs') {
  return element('table', { class: className }, element('tbody', {},
    ...rows.map(([name, value]) =>
      element('tr', {}, element('th', { scope: 'row', text: name }), element('td', { text: value })))));
}
