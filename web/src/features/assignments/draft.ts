/** A new assignment as it is being written. */
import type { NewAssignment } from '@/api';
import { say } from '@/language';
import { dueProblem, fromField } from './dates';

export interface Item {
  readonly key: string;
  readonly title: string;
  readonly rig: 'palpation' | 'probing';
  readonly case_id?: string;
  readonly tuned?: string;
  /** Its bone is whole. */ readonly whole?: boolean;
  /** Why its breaches may not be felt; absent where they can. */ readonly sign?: string;
}
export interface Chosen extends Item {
  readonly blind: string;
}

export interface Draft {
  readonly title: string;
  readonly chosen: readonly Chosen[];
  readonly cohort: string;
  readonly people: readonly string[];
  readonly ordering: 'fixed' | 'random' | 'balanced';
  readonly repeats: number;
  readonly due: string;
  readonly release: 'held' | 'released' | 'at_once';
}

export const kNoDraft: Draft = {
  title: '',
  chosen: [],
  cohort: '',
  people: [],
  ordering: 'random',
  repeats: 1,
  due: '',
  release: 'held',
};

/** A, B, … Z, AA: the default blind name of a case. */
export function letters(index: number): string {
  return index < 26 ? String.fromCharCode(65 + index) : letters(Math.floor(index / 26) - 1) + letters(index % 26);
}

/** The next unused blind name. */
export function nextBlind(chosen: readonly Chosen[]): string {
  for (let i = 0; ; ++i) {
    const name = say('Case {letters}', { letters: letters(i) });
    if (!chosen.some(({ blind }) => blind === name)) return name;
  }
}

export function toggled(draft: Draft, item: Item): Draft {
  const there = draft.chosen.some(({ key }) => key === item.key);
  return {
    ...draft,
    chosen: there
      ? draft.chosen.filter(({ key }) => key !== item.key)
      : [...draft.chosen, { ...item, blind: nextBlind(draft.chosen) }],
  };
}

/** The first thing that is missing or wrong; empty: the assignment can be created. */
export function firstProblem(draft: Draft, now_us: number): string {
  if (draft.title.trim() === '') return say('Enter a title.');
  if (draft.chosen.length === 0) return say('Choose at least one case.');
  if (draft.cohort === '' && draft.people.length === 0) return say('Choose a cohort or trainees.');
  const names = draft.chosen.map(({ blind }) => blind.trim()).filter((name) => name !== '');
  const wrongDue = dueProblem(draft.due, now_us);
  if (wrongDue !== '') return wrongDue;
  if (new Set(names).size !== names.length) return say('Two cases have the same blind name.');
  return '';
}

export function requestOf(draft: Draft): NewAssignment {
  const due = fromField(draft.due);
  return {
    title: draft.title.trim(),
    cases: draft.chosen.map(({ case_id, tuned, blind }) => ({
      ...(case_id === undefined ? { scenario: { tuned: tuned ?? '' } } : { case: case_id }),
      ...(blind.trim() === '' ? {} : { name: blind.trim() }),
    })) as NonNullable<NewAssignment['cases']>, // the server checks the names of scenarios
    ...(draft.cohort === '' ? {} : { cohort: draft.cohort }),
    ...(draft.people.length === 0 ? {} : { people: [...draft.people] }),
    ordering: draft.ordering,
    repeats: draft.repeats,
    release: draft.release,
    ...(due === null ? {} : { due_utc_us: due }),
  };
}

/** Trials that one trainee will do. */
export const trialsEach = ({ chosen, repeats }: Draft) => chosen.length * repeats;
