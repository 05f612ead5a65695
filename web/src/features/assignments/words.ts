import type { AssignmentSummary, Release } from '@/api';

export const kReleaseWords: Record<Release, { readonly name: string; readonly means: string }> = {
  held: { name: 'held', means: 'Trainees see no result until you release them.' },
  released: { name: 'released', means: 'Trainees see their results and comments.' },
  at_once: { name: 'at once', means: 'Trainees see each result as soon as it is there.' },
};

export const kOrderWords = {
  fixed: 'the same order for everybody, as listed',
  random: 'an order of chance for everybody',
  balanced: 'orders that balance each other over the group',
} as const;

export const kToDrill = 'to be drilled, then felt';

/** How many trials begin with the burr; empty: none does. */
export function drilling({ to_drill, planned }: Pick<AssignmentSummary, 'to_drill' | 'planned'>): string {
  if (to_drill === 0) return '';
  return to_drill === planned ? kToDrill : `${to_drill} of ${planned} ${kToDrill}`;
}

export type Due = 'none' | 'late' | 'soon' | 'later';
const kSoon_us = 3 * 24 * 3600 * 1e6;

/** How pressing something is that is not all done. */
export function pressing({ due_utc_us, done, planned }: Pick<AssignmentSummary, 'due_utc_us' | 'done' | 'planned'>, now_us: number): Due {
  if (due_utc_us === null || done >= planned) return 'none';
  const left = due_utc_us - now_us;
  return left < 0 ? 'late' : left < kSoon_us ? 'soon' : 'later';
}
