import { expect, it } from 'vitest';
import { fromAddress, kStartView, toAddress } from './search';

it('is the same after it was an address', () => {
  const view = { search: 'ö & 50 %', answer: 'incorrect', sort: 'person', order: 'ascending', page: 3 } as const;
  expect(fromAddress(toAddress(view))).toEqual(view);
  expect(toAddress(kStartView)).toBe('');
});

it('takes an address of nonsense for the start', () => {
  expect(fromAddress('answer=maybe&sort=colour&order=up&page=0.5')).toEqual(kStartView);
});
