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

/** Sets what differs: what is set again as it was makes the browser style it again. */
export function put(holder, key, value) {
  if (holder[key] !== value) holder[key] = value;
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

/** Pictures on buttons: paths in a square of 16. */
const ICONS = {
  first: 'M3 3h2v10H3z M13 3v10L6 8z',
  back: 'M11 3v10L4 8z M12 3h1.6v10H12z',
  forward: 'M5 3v10l7-5z M2.4 3H4v10H2.4z',
  play: 'M4 2.5v11L13 8z',
  pause: 'M4 3h3v10H4z M9 3h3v10H9z',
  flag: 'M3 2h1.6v12H3z M5.4 2.6H13l-2 2.7 2 2.7H5.4z',
  theme: 'M8 1.5a6.5 6.5 0 1 0 0 13z M8 1.5a6.5 6.5 0 0 1 0 13v-1.4a5.1 5.1 0 0 0 0-10.2z',
};

/** @param {keyof typeof ICONS} name */
export function icon(name) {
  const picture = document.createElementNS('http://www.w3.org/2000/svg', 'svg');
  picture.setAttribute('viewBox', '0 0 16 16');
  picture.setAttribute('class', 'icon');
  picture.setAttribute('aria-hidden', 'true');
  const path = document.createElementNS('http://www.w3.org/2000/svg', 'path');
  path.setAttribute('d', ICONS[name]);
  picture.append(path);
  return picture;
}

/** A button with a picture. */
export function iconButton(name, help, act, properties = {}) {
  const made = button('', help, act, properties);
  made.append(icon(name));
  return made;
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
