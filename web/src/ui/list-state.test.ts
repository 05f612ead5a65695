import { expect, it } from 'vitest';
import * as v from 'valibot';
import { askedOf, searchOf } from './list-state';

const word = <const Words extends readonly string[]>(words: Words) =>
  v.fallback(v.optional(v.picklist(words)), undefined);
const text = v.fallback(v.optional(v.string()), undefined);
const trialsAsked = v.object({
  search: text,
  cursor: text,
  sort: word(['case', 'person']),
  order: word(['ascending', 'descending']),
  answer: word(['correct', 'incorrect']),
});

it('is the same after it was an address', () => {
  const asked = { search: 'ö & 50 %', answer: 'incorrect', sort: 'person', order: 'ascending', cursor: 'abc' } as const;
  expect(askedOf(trialsAsked, searchOf(asked))).toEqual(asked);
  expect(searchOf({})).toBe('');
  expect(searchOf({ search: '', sort: undefined })).toBe('');
});

it('takes what it does not know for absent', () => {
  expect(searchOf(askedOf(trialsAsked, 'answer=maybe&sort=colour&order=up&page=2&search=L3'))).toBe('search=L3');
});
