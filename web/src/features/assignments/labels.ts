import type { AssignmentSummary, Release } from '@/api';
import { marked, say } from '@/language';

export const kReleaseLabels: Record<Release, { readonly name: string; readonly description: string }> = {
  held: { name: marked('not released'), description: marked('Trainees see no results until you release them.') },
  released: { name: marked('released'), description: marked('Trainees see their results and comments.') },
  at_once: {
    name: marked('released immediately'),
    description: marked('Trainees see each result as soon as it is available.'),
  },
};

export const kOrderLabels = {
  fixed: marked('Same order for every trainee, as listed'),
  random: marked('Random order per trainee'),
  balanced: marked('Orders balanced across trainees'),
} as const;

export const kOrderWords: Readonly<Record<string, string>> = {
  fixed: marked('fixed'),
  random: marked('random'),
  balanced: marked('balanced'),
};

export const kRigWords = { palpation: marked('palpation'), probing: marked('probing') } as const;

export const kDrillThenPalpate = marked('drill, then palpate');

/** How many trials begin with the burr; empty: none does. */
export function drillingLabel({ to_drill, planned }: Pick<AssignmentSummary, 'to_drill' | 'planned'>): string {
  if (to_drill === 0) return '';
  return to_drill === planned
    ? say(kDrillThenPalpate)
    : say('{to_drill} of {planned}: drill, then palpate', { to_drill, planned });
}

export type Due = 'none' | 'late' | 'soon' | 'later';
const kSoon_us = 3 * 24 * 3600 * 1e6;

/** Urgency of an assignment that is not complete. */
export function dueState(
  { due_utc_us, done, planned }: Pick<AssignmentSummary, 'due_utc_us' | 'done' | 'planned'>,
  now_us: number,
): Due {
  if (due_utc_us === null || done >= planned) return 'none';
  const left = due_utc_us - now_us;
  return left < 0 ? 'late' : left < kSoon_us ? 'soon' : 'later';
}
