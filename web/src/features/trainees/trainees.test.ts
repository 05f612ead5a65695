import { describe, expect, it } from 'vitest';
import type { TraineeSummary } from '@/api';
import { share, utcMicroseconds } from '@/units';
import { isAway, isInactive, membersOf, runningShare, shownOf } from './standing';

const one = (changes: Partial<TraineeSummary>): TraineeSummary => ({
  trainee: 'S01',
  trials: 12,
  right: 9,
  share: share(0.75),
  wilson_low: share(0.47),
  wilson_high: share(0.91),
  state: 'learning',
  certified: false,
  why: '',
  next: { scenario: 'hard', why: '' },
  simulated: false,
  last_utc_us: utcMicroseconds(0),
  ...changes,
});
const kDay_us = 86_400_000_000;

describe('the list of trainees', () => {
  it('calls a trainee inactive after more than sixty days without a trial', () => {
    expect(isInactive(one({}), 60 * kDay_us)).toBe(false);
    expect(isInactive(one({}), 61 * kDay_us)).toBe(true);
  });

  it('is narrowed by state', () => {
    const all = [one({}), one({ trainee: 'S02', state: 'relapsed' }), one({ trainee: 'T03' })];
    expect(shownOf(all, 'relapsed', 0).map(({ trainee }) => trainee)).toEqual(['S02']);
    expect(shownOf(all, 'all', 0)).toHaveLength(3);
  });
});

it('the share of the last ten is not said of fewer than five trials, and forgets what is older than ten', () => {
  expect(runningShare([true, true, true, true])).toEqual([null, null, null, null]);
  const right = [...Array<boolean>(10).fill(false), ...Array<boolean>(10).fill(true)];
  const running = runningShare(right);
  expect(running[9]).toBe(0);
  expect(running[14]).toBe(0.5);
  expect(running[19]).toBe(1);
});

describe('the members of cohorts', () => {
  const member = (trainee: string, behind: boolean, day: number | null) => ({
    trainee,
    trials: day === null ? 0 : 12,
    recent_trials: day === null ? 0 : 10,
    recent_right: 0,
    others_share: null,
    behind,
    last_utc_us: day === null ? null : utcMicroseconds(day * kDay_us),
  });

  it('come with who is behind first, then who has been away longest', () => {
    const cohorts = [
      { id: 'a', name: 'Fellows', bins: [], trainees: [member('F1', false, 9), member('F2', true, 9)] },
      { id: 'b', name: 'Residents', bins: [], trainees: [member('R1', false, 3), member('R2', false, null)] },
    ];
    expect(membersOf(cohorts).map(({ trainee, cohort }) => `${trainee} ${cohort}`)).toEqual([
      'F2 Fellows',
      'R2 Residents',
      'R1 Residents',
      'F1 Fellows',
    ]);
  });

  it('are away after more days than were chosen without a trial, or with none at all', () => {
    expect(isAway(member('R1', false, 0), 30, 30 * kDay_us)).toBe(false);
    expect(isAway(member('R1', false, 0), 30, 31 * kDay_us)).toBe(true);
    expect(isAway(member('R2', false, null), 30, 0)).toBe(true);
  });
});
