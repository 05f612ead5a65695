/** Filter of the list of trainees, inactivity, and the running share of correct answers. Pure. */
import type { CohortProgress, TraineePace, TraineeSummary } from '@/api';

const kDay_us = 86_400_000_000;
const kInactive_days = 60;

export type Show = 'all' | TraineeSummary['state'] | 'inactive';

/** No trial for two months. */
export const isInactive = (one: Pick<TraineeSummary, 'last_utc_us'>, now_utc_us: number) =>
  now_utc_us - one.last_utc_us > kInactive_days * kDay_us;

export const shownOf = (trainees: readonly TraineeSummary[], show: Show, now_utc_us: number): TraineeSummary[] =>
  trainees.filter((one) => show === 'all' || (show === 'inactive' ? isInactive(one, now_utc_us) : one.state === show));

const kWindow = 10;

/** Share of right answers among the last ten, once there are five. */
export function runningShare(right: readonly boolean[]): (number | null)[] {
  return right.map((_, i) => {
    const last = right.slice(Math.max(0, i + 1 - kWindow), i + 1);
    return last.length < 5 ? null : last.filter(Boolean).length / last.length;
  });
}

/** A trainee of a cohort. */
export interface Member extends TraineePace {
  readonly cohort: string;
}

/** No trial in the last days, or none at all. */
export const isAway = ({ last_utc_us: last }: Pick<TraineePace, 'last_utc_us'>, days: number, now_utc_us: number) =>
  last === null || now_utc_us - last > days * kDay_us;

/** Everybody in the cohorts: who is behind first, then who has been away longest. */
export const membersOf = (cohorts: readonly CohortProgress[]): Member[] =>
  cohorts
    .flatMap(({ name, trainees }) => trainees.map((one) => ({ ...one, cohort: name })))
    .sort((a, b) => Number(b.behind) - Number(a.behind) || (a.last_utc_us ?? 0) - (b.last_utc_us ?? 0));
