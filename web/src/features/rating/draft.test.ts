import { expect, it } from 'vitest';
import { globalRating, idFrom, itemOf, itemProblem, newItem } from './draft';

const full = { ...newItem(), label: 'Flow', low_text: 'stops', high_text: 'moves on' };

it('begins with seven items of 1 to 5 that are described at both ends and in the middle', () => {
  const items = globalRating().map((one) => newItem(one));
  expect(items).toHaveLength(7);
  for (const one of items) {
    expect(itemProblem(one)).toBe('');
    expect(itemOf(one)).toMatchObject({ low: 1, high: 5 });
    expect(one.middle_text).not.toBe('');
  }
});

it.each([
  [{ ...full, label: ' ' }, 'Name'],
  [{ ...full, high: '1' }, 'more points'],
  [{ ...full, high: '11' }, '0 to 10'],
  [{ ...full, low: '1.5' }, '0 to 10'],
  [{ ...full, high_text: '' }, 'both ends'],
])('names what is wrong with %o', (draft, words) => {
  expect(itemProblem(draft)).toContain(words);
});

it('makes an id of a title that an export can name a column by', () => {
  expect(idFrom('Global rating scale (2026)')).toBe('global_rating_scale_2026');
  expect(idFrom('1. Würdigung')).toBe('w_rdigung');
  expect(idFrom('x'.repeat(50))).toHaveLength(32);
});
