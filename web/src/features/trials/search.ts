/** What the list of trials shows, as part of an address. Pure. */
import type { TrialSearch } from '@/api';

export type TrialView = TrialSearch;

export const kAnswers = [
  { value: 'any', text: 'all' },
  { value: 'correct', text: 'correct' },
  { value: 'incorrect', text: 'incorrect' },
  { value: 'none', text: 'no answer' },
] as const;
const kSorts = ['started', 'case', 'person', 'station', 'duration'] as const;
export const kStartView: TrialView = { search: '', answer: 'any', sort: 'started', order: 'descending', page: 0 };

/** What is unknown in an address counts as absent. */
export function fromAddress(search: string): TrialView {
  const parameters = new URLSearchParams(search);
  const page = Number(parameters.get('page') ?? 1);
  return {
    search: parameters.get('find') ?? '',
    answer: kAnswers.find(({ value }) => value === parameters.get('answer'))?.value ?? kStartView.answer,
    sort: kSorts.find((sort) => sort === parameters.get('sort')) ?? kStartView.sort,
    order: parameters.get('order') === 'ascending' ? 'ascending' : 'descending',
    page: Number.isInteger(page) && page >= 1 ? page - 1 : 0,
  };
}

/** Without what is as at the start. */
export function toAddress({ search, answer, sort, order, page }: TrialView): string {
  const parameters = new URLSearchParams();
  if (search !== '') parameters.set('find', search);
  if (answer !== kStartView.answer) parameters.set('answer', answer);
  if (sort !== kStartView.sort) parameters.set('sort', sort);
  if (order !== kStartView.order) parameters.set('order', order);
  if (page !== 0) parameters.set('page', String(page + 1));
  return parameters.toString();
}
