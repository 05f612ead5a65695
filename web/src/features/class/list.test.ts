import { expect, it } from 'vitest';
import { kExample, plainList } from './list';

it('reads what spreadsheets write', () => {
  expect(plainList('\uFEFFFull name;PGY;Badge number\r\n"Berg, Ida";1;10021\r\n')).toBe(
    'name,level,badge\n"Berg, Ida",1,10021\n',
  );
  expect(plainList('Name\tPIN\nIda\t4711')).toBe('name,pin\nIda,4711');
});

it('keeps every line in its place, so that errors name the right one', () => {
  expect(plainList('name,level\n\nIda,1').split('\n')[2]).toBe('Ida,1');
});

it('keeps a column that it does not know, for the server to refuse', () => {
  expect(plainList('name,shoe size\nIda,41')).toContain('shoe size');
});

it('leaves its own example as it is', () => {
  expect(plainList(kExample)).toBe(kExample);
});
