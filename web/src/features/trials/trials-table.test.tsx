// @vitest-environment jsdom
import { cleanup, render, screen, within } from '@testing-library/react';
import userEvent from '@testing-library/user-event';
import { afterEach, describe, expect, it } from 'vitest';
import type { TrialSummary } from '@/api';
import { formatCount, second, utcMicroseconds } from '@/units';
import { TrialsTable } from './trials-table';

afterEach(cleanup);

const trial = (changes: Partial<TrialSummary>): TrialSummary => ({
  id: 'a',
  case_id: 'c',
  case_title: 'L3 left pedicle',
  station: 'lab',
  operator_name: 'P4vbzdez6',
  person: 'A. Resident',
  simulated: false,
  started_utc_us: utcMicroseconds(1.7e15),
  duration_s: second(61.2),
  samples: 244800,
  state: 'assessed',
  correct: true,
  ...changes,
});

const kList = {
  list: { asked: {}, change: () => undefined, open: () => undefined, search: '' },
  page: { total: 2, more_than_total: false, next: null, previous: null },
  views: { views: [], save: () => Promise.resolve(), remove: () => Promise.resolve() },
};

const cellsOf = (row: HTMLElement) =>
  within(row)
    .getAllByRole('cell')
    .map((cell) => cell.textContent);

describe('the table of trials', () => {
  it('names the person where it is known, and asks for another order by its headers', async () => {
    const asked: unknown[] = [];
    render(
      <TrialsTable
        trials={[trial({}), trial({ id: 'b', person: '' })]}
        {...kList}
        list={{ ...kList.list, asked: { sort: 'person' }, change: (next) => asked.push(next) }}
      />,
    );
    const [, known, unknown] = screen.getAllByRole('row');
    expect(known?.textContent).toContain('A. Resident');
    expect(unknown?.textContent).toContain('P4vbzdez6');
    expect(screen.getByRole('columnheader', { name: /Person/ }).getAttribute('aria-sort')).toBe('ascending');
    await userEvent.click(screen.getByRole('button', { name: 'Person' }));
    await userEvent.click(screen.getByRole('button', { name: 'Case' }));
    await userEvent.click(screen.getByRole('button', { name: 'incorrect' }));
    await userEvent.type(screen.getByRole('searchbox'), 'L');
    expect(asked).toEqual([
      { sort: 'person', order: 'descending' },
      { sort: 'case', order: undefined },
      { answer: 'incorrect' },
      { search: 'L' },
    ]);
  });

  it('turns pages by the cursors of the server, and counts what was found', async () => {
    const asked: unknown[] = [];
    render(
      <TrialsTable
        trials={[trial({})]}
        {...kList}
        list={{ ...kList.list, asked: { cursor: 'here', answer: 'correct' }, change: (next) => asked.push(next) }}
        page={{ total: 1000, more_than_total: true, next: 'onwards', previous: 'back' }}
      />,
    );
    expect(screen.getByRole('status').textContent).toBe(`${formatCount(1000)}+ found`);
    for (const name of ['Next', 'Previous', 'First']) await userEvent.click(screen.getByRole('button', { name }));
    expect(asked).toEqual([{ cursor: 'onwards' }, { cursor: 'back' }, {}]);
  });

  it('holds the place of rows while they come, and says that it is busy', () => {
    render(<TrialsTable trials={undefined} {...kList} />);
    expect(screen.getByRole('table').getAttribute('aria-busy')).toBe('true');
    expect(screen.getAllByRole('row').length).toBeGreaterThan(5);
  });

  it('links every trial by its case and escapes its id', () => {
    render(<TrialsTable trials={[trial({ id: 'a/b' })]} {...kList} />);
    expect(screen.getByRole('link', { name: 'L3 left pedicle' }).getAttribute('href')).toBe('/trials/a%2Fb');
  });

  it.each([
    [{ correct: true }, '✓ correct', 'assessed'],
    [{ correct: false }, '✗ incorrect', 'assessed'],
    [{ correct: null }, 'none', 'assessed'],
    [{ correct: null, state: 'assessing' }, '–', 'assessing…'],
    [{ correct: null, state: 'failed' }, '–', 'failed'],
  ] satisfies [Partial<TrialSummary>, string, string][])('says of %o: %s, %s', (changes, answer, state) => {
    render(<TrialsTable trials={[trial(changes)]} {...kList} />);
    const [, row] = screen.getAllByRole('row');
    if (!row) throw new Error('no row');
    expect(cellsOf(row).slice(-2)).toEqual([answer, state]);
  });

  it('marks a simulated operator, and only such a one', () => {
    render(
      <TrialsTable
        trials={[trial({}), trial({ id: 'b', person: '', operator_name: 'hand', simulated: true })]}
        {...kList}
      />,
    );
    const [, human, simulated] = screen.getAllByRole('row');
    if (!human || !simulated) throw new Error('two rows expected');
    expect(within(human).queryByText('simulated')).toBeNull();
    expect(within(simulated).getByText('simulated')).toBeTruthy();
  });
});
