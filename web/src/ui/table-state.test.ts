import { expect, it } from 'vitest';
import { kTableStart, readTableState, withTableState } from './table-state';

it('is the same after it was an address, and leaves the address’s other parameters', () => {
  const state = { typed: 'ö & 50 %', sort: { column: 3, down: true }, page: 2 };
  const search = withTableState('study=a', '', state);
  expect(new URLSearchParams(search).get('study')).toBe('a');
  expect(readTableState(search, '')).toEqual(state);
});

it('is the start of the table where the address says nothing, or nonsense', () => {
  expect(readTableState('', '')).toEqual(kTableStart);
  expect(readTableState('sort=up&page=-3', '')).toEqual(kTableStart);
  expect(withTableState('find=x&page=4', '', kTableStart)).toBe('');
});

it('keeps the tables of one page apart', () => {
  const search = withTableState('find=x', 'b-', { ...kTableStart, typed: 'y' });
  expect(readTableState(search, '').typed).toBe('x');
  expect(readTableState(search, 'b-').typed).toBe('y');
});
