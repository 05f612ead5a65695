// @vitest-environment jsdom
import { QueryClient, QueryClientProvider } from '@tanstack/react-query';
import { cleanup, fireEvent, render, screen } from '@testing-library/react';
import { afterEach, expect, it, vi } from 'vitest';
import type { RatingRequest } from '@/api';
import { utcMicroseconds } from '@/units';
import { worstSection } from './cross-section';
import { RatingForm } from './rating-form';

afterEach(cleanup);

const item = (label: string, high: number) => ({
  label,
  text: '',
  low: 1,
  high,
  low_text: 'poor',
  middle_text: '',
  high_text: 'excellent',
});
const request: RatingRequest = {
  rubric: {
    id: 'osats',
    version: 1,
    title: 'Global rating',
    items: [item('Tissue', 5), item('Motion', 3)],
    reason: '',
    made_utc_us: utcMicroseconds(0),
    made_by: 'director',
  },
  blind: false,
  raters: 2,
  submitted: 0,
  complete: false,
  may_rate: true,
  ratings: [],
};
const shown = (of: RatingRequest) =>
  render(
    <QueryClientProvider client={new QueryClient()}>
      <RatingForm trial="t" request={of} onRated={vi.fn()} />
    </QueryClientProvider>,
  );
const submit = () => screen.getByRole('button', { name: /Submit|Supersede/ }) as HTMLButtonElement;

it('is submitted once every item has its points', () => {
  shown(request);
  expect(screen.getAllByRole('radio')).toHaveLength(5 + 3);
  fireEvent.click(screen.getAllByRole('radio', { name: '2' })[0] as HTMLElement);
  expect(submit().disabled).toBe(true);
  fireEvent.click(screen.getAllByRole('radio', { name: '3' })[1] as HTMLElement);
  expect(submit().disabled).toBe(false);
});

it('asks for a reason to supersede the own rating, which it begins with', () => {
  const own = {
    rater: 'me',
    own: true,
    scores: [4, 2],
    total: 6,
    comment: 'steady',
    reason: '',
    independent: true,
    holds: true,
    made_utc_us: utcMicroseconds(0),
  };
  shown({ ...request, submitted: 1, ratings: [own] });
  expect((screen.getByLabelText('Comment (optional)') as HTMLInputElement).value).toBe('steady');
  expect(submit().disabled).toBe(true);
  fireEvent.change(screen.getByLabelText('Reason to supersede your rating'), { target: { value: 'wrong line' } });
  expect(submit().disabled).toBe(false);
});

it('draws the section of the last drilling that a station measured, and none of others', () => {
  const worst = {
    depth_m: 0.014,
    beyond_m: 0.001,
    cortex_m: [0.004, 0],
    farthest_m: [0.005, 0],
    outline_m: [
      [0.004, 0],
      [0, 0.004],
      [-0.004, 0],
    ],
    centre_m: [0.003, 0],
    radius_m: 0.002,
  };
  const event = (detail: unknown) => ({ t_s: 0 as never, kind: 'drilled', detail });
  expect(worstSection([event({ channel: { worst } })])?.beyond_m).toBe(0.001);
  expect(worstSection([event({ channel: { worst: null } })])).toBeNull();
  expect(worstSection([event({ channel: 7 })])).toBeNull();
  expect(worstSection([])).toBeNull();
});
