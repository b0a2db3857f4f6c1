// Tables whose columns can be sorted: by the numbers in their texts, or by the texts where there are none.
import { element } from '../dom.js';

const LONG = 26; // letters, of a head that gets more room

/** The first number of a text ("★ 0.38 mm" -> 0.38); null where there is none. */
export function numberIn(text) {
  const found = /[-−]?\d[\d,]*(\.\d+)?(e[-+]?\d+)?/i.exec(text);
  return found ? Number(found[0].replaceAll(',', '').replace('−', '-')) : null;
}

/** In which order rows stand when sorted by these texts; what has no value comes last either way. */
export function orderBy(texts, down) {
  const numbers = texts.map(numberIn);
  const byNumber = numbers.some((value) => value !== null);
  const value = (k) => (byNumber ? numbers[k] : texts[k]);
  const sign = down ? -1 : 1;
  return texts.map((_, k) => k).sort((a, b) => {
    const [p, q] = [value(a), value(b)];
    if (p === null || q === null) return (p === null) - (q === null) || a - b;
    return sign * (p < q ? -1 : p > q ? 1 : 0) || a - b;
  });
}

/**
 * A table with buttons for heads.
 * @param {string[]} columns @param {{texts: string[], row: HTMLElement}[]} rows in the order they have at first
 */
export function sortableTable(columns, rows, properties = {}) {
  const body = element('tbody', {}, ...rows.map(({ row }) => row));
  let by = null;
  let down = false;
  const heads = columns.map((text, column) => element('th', { scope: 'col', class: text.length > LONG ? 'long' : null }, text === '' ? null : element('button', {
    type: 'button', class: 'sort', text, title: 'Sort by this column',
    on: {
      click: () => {
        [by, down] = by === column ? (down ? [null, false] : [column, true]) : [column, false];
        const order = by === null ? rows.map((_, k) => k) : orderBy(rows.map(({ texts }) => texts[by] ?? ''), down);
        body.replaceChildren(...order.map((k) => rows[k].row));
        heads.forEach((head, k) => {
          if (k === by) head.setAttribute('aria-sort', down ? 'descending' : 'ascending');
          else head.removeAttribute('aria-sort');
        });
      },
    },
  })));
  return element('table', properties, element('thead', {}, element('tr', {}, ...heads)), body);
}
