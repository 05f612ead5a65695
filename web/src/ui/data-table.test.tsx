// @vitest-environment jsdom
import { cleanup, render, screen } from '@testing-library/react';
import userEvent from '@testing-library/user-event';
import { afterEach, expect, it } from 'vitest';
import { DataTable, type DataColumn } from './data-table';

afterEach(cleanup);

interface Person {
  readonly name: string;
  readonly trials: number | null;
}
const kPeople: readonly Person[] = [
  { name: 'S10', trials: 4 },
  { name: 's9', trials: null },
  { name: 'T1', trials: 11 },
  { name: 'T2', trials: null },
];
const kColumns: readonly DataColumn<Person>[] = [
  { name: 'Name', by: ({ name }) => name, cell: ({ name }) => name },
  { name: <em>Trials</em>, title: 'Trials', by: ({ trials }) => trials, cell: ({ trials }) => trials ?? '–' },
  { name: 'Remark', cell: () => '' },
];

const shown = (people: readonly Person[] = kPeople, more: { pageSize?: number; partial?: boolean } = {}) => (
  <DataTable
    caption="People"
    order="newest first"
    rows={people}
    keyOf={({ name }) => name}
    empty="Nobody."
    filter={{ label: 'Filter by name', text: ({ name }) => name }}
    columns={kColumns}
    {...more}
  />
);
const names = () => screen.getAllByRole('rowheader').map((cell) => cell.textContent);
const sortOf = (column: RegExp) => screen.getByRole('columnheader', { name: column }).getAttribute('aria-sort');
const press = (name: string) => userEvent.click(screen.getByRole('button', { name }));

it('keeps the order of its rows until a header is pressed, then sorts up, down and not', async () => {
  render(shown());
  expect(names()).toEqual(['S10', 's9', 'T1', 'T2']);
  expect(screen.getByRole('table', { name: 'People, newest first' })).toBeTruthy();
  await press('Name');
  expect(names(), 'numbers in names count as numbers').toEqual(['s9', 'S10', 'T1', 'T2']);
  expect(sortOf(/Name/)).toBe('ascending');
  expect(screen.getByRole('table', { name: 'People, sorted by Name' })).toBeTruthy();
  await press('Name');
  expect(names()).toEqual(['T2', 'T1', 'S10', 's9']);
  expect(sortOf(/Name/)).toBe('descending');
  await press('Name');
  expect(names()).toEqual(['S10', 's9', 'T1', 'T2']);
  expect(sortOf(/Name/)).toBeNull();
});

it('puts rows without a value last, whichever way it sorts', async () => {
  render(shown());
  await press('Sort by Trials');
  expect(names()).toEqual(['T1', 'S10', 's9', 'T2']);
  await press('Sort by Trials');
  expect(names()).toEqual(['S10', 'T1', 's9', 'T2']);
});

it('has no button where a column has nothing to sort by', () => {
  render(shown());
  expect(screen.queryByRole('button', { name: /Remark/ })).toBeNull();
});

it('narrows the rows to what is typed, and says how many are left', async () => {
  render(shown());
  await userEvent.type(screen.getByLabelText('Filter by name'), 't');
  expect(names()).toEqual(['T1', 'T2']);
  expect(screen.getByRole('status').textContent).toBe('2 of 4');
  await userEvent.type(screen.getByLabelText('Filter by name'), 'x');
  expect(screen.getByText('No rows match.')).toBeTruthy();
});

it('shows page by page, and returns to a page that is there when rows go', async () => {
  const { rerender } = render(shown(kPeople, { pageSize: 2 }));
  expect(names()).toEqual(['S10', 's9']);
  await press('Next');
  expect(names()).toEqual(['T1', 'T2']);
  expect(screen.getByText('3–4 of 4')).toBeTruthy();
  rerender(shown(kPeople.slice(0, 1), { pageSize: 2 }));
  expect(names()).toEqual(['S10']);
  expect(screen.queryByRole('button', { name: 'Next' })).toBeNull();
});

it('says of rows that the server hands out part by part that only those loaded are sorted', async () => {
  render(shown(kPeople, { pageSize: 2, partial: true }));
  expect(names()).toHaveLength(4);
  await press('Name');
  expect(screen.getByText('Only the rows loaded so far are searched and sorted.')).toBeTruthy();
});

it('sorts by what a row says now, not by what it said before', async () => {
  const { rerender } = render(shown());
  await press('Name');
  rerender(shown([{ name: 'b', trials: 1 }, ...kPeople.slice(2)]));
  expect(names()).toEqual(['b', 'T1', 'T2']);
});

it('keeps filter, order and page in the address when it is told to', async () => {
  window.history.replaceState(null, '', '/people?study=a&find=t&sort=0down');
  render(
    <DataTable
      caption="People"
      rows={kPeople}
      keyOf={({ name }) => name}
      empty="Nobody."
      columns={kColumns}
      address=""
      filter={{ label: 'Filter by name', text: ({ name }) => name }}
    />,
  );
  expect(names()).toEqual(['T2', 'T1']);
  await press('Name'); // from down to none
  await userEvent.type(screen.getByRole('searchbox'), '1');
  expect(window.location.search).toBe('?study=a&find=t1');
  window.history.replaceState(null, '', '/');
});
