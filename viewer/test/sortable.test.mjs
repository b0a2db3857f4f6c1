import assert from 'node:assert/strict';
import test from 'node:test';
import { numberIn, orderBy } from '../src/panels/sortable.js';

test('the number of a text is its first', () => {
  assert.deepEqual(['0.38 mm', '★ 1,234 ms', '−3.5', '-2', '1.2e-5', '4.1 ± 0.2', '–', 'kiss'].map(numberIn), [0.38, 1234, -3.5, -2, 1.2e-5, 4.1, null, null]);
});

test('rows are sorted by numbers, those without come last either way, equal ones keep their order', () => {
  const texts = ['10 mm', '9 mm', '–', '9 mm', '100 mm'];
  assert.deepEqual(orderBy(texts, false), [1, 3, 0, 4, 2]);
  assert.deepEqual(orderBy(texts, true), [4, 0, 1, 3, 2]);
  assert.deepEqual(orderBy(['tunnel', 'city', 'street'], false), [1, 2, 0]);
});
