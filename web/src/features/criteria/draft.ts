/** Criteria and a curriculum as they are being written, in the units of a table. Pure. */
import type { NewCurriculum, NewRequirement, Requirement } from '@/api';
import { criteriaOf } from '@/api';
import { say } from '@/language';
import { plainNumber, typedIn } from '@/units';

export type Kind = Requirement['kind'];

/** What is typed stays text until it is sent. */
export interface RequirementDraft {
  readonly key: number;
  readonly kind: Kind;
  readonly metric: string;
  readonly side: 'at_most' | 'at_least';
  /** In the unit that is shown. */
  readonly bound: string;
  readonly times: string;
  /** Of the last so many trials; empty: of all. */
  readonly last: string;
  /** Per cent. */
  readonly share: string;
  readonly level: string;
  readonly adequate: string;
  readonly inadequate: string;
  readonly basis: string;
}

let made = 0;
export function newRequirement(kind: Kind, metric = ''): RequirementDraft {
  made += 1;
  return {
    key: made,
    kind,
    metric,
    side: 'at_most',
    bound: '',
    times: '3',
    last: kind === 'metric' ? '5' : '',
    share: '80',
    level: '95',
    adequate: '10',
    inadequate: '25',
    basis: '',
  };
}

const text = (value: number | undefined, factor = 1) => (value === undefined ? '' : plainNumber(value * factor));

export function draftOf(of: Requirement, unitOf: (metric: string) => string): RequirementDraft {
  const blank = newRequirement(of.kind, of.metric);
  return {
    ...blank,
    side: of.side ?? blank.side,
    bound: text(of.bound, typedIn(unitOf(of.metric ?? '')).perSi),
    times: of.times === undefined ? blank.times : text(of.times),
    last: of.last === undefined || of.last === 0 ? '' : text(of.last),
    share: of.share === undefined ? blank.share : text(of.share, 100),
    level: of.level === undefined ? blank.level : text(of.level, 100),
    adequate: of.adequate === undefined ? blank.adequate : text(of.adequate, 100),
    inadequate: of.inadequate === undefined ? blank.inadequate : text(of.inadequate, 100),
    basis: of.basis,
  };
}

const isNumber = (typed: string) => typed.trim() !== '' && Number.isFinite(Number(typed));
const isCount = (typed: string) => /^[1-9]\d{0,2}$/.test(typed.trim());
const isShare = (typed: string) => isNumber(typed) && Number(typed) > 0 && Number(typed) < 100;

/** What is missing or wrong; empty: nothing. */
export function requirementProblem(of: RequirementDraft): string {
  switch (of.kind) {
    case 'metric':
      if (of.metric === '') return say('Choose a metric.');
      if (!isNumber(of.bound)) return say('Enter the bound as a number.');
      if (!isCount(of.times)) return say('Enter how many trials must keep the bound.');
      if (of.last !== '' && !isCount(of.last)) return say('Enter of how many trials, or leave it empty for all.');
      if (of.last !== '' && Number(of.last) < Number(of.times))
        return say('More trials must keep the bound than are looked at.');
      return '';
    case 'recognition':
      if (!isShare(of.share) || !isShare(of.level)) return say('Enter percentages between 0 and 100.');
      return of.last === '' || isCount(of.last) ? '' : say('Enter of how many answers, or leave it empty for all.');
    case 'lc_cusum':
      if (!isShare(of.adequate) || !isShare(of.inadequate)) return say('Enter percentages between 0 and 100.');
      return Number(of.adequate) < Number(of.inadequate)
        ? ''
        : say('The acceptable failure rate must be below the unacceptable one.');
  }
}

export function requestOf(of: RequirementDraft, unitOf: (metric: string) => string): NewRequirement {
  const last = of.last === '' ? 0 : Number(of.last);
  const basis = of.basis === '' ? {} : { basis: of.basis };
  switch (of.kind) {
    case 'metric':
      return {
        kind: of.kind,
        metric: of.metric,
        side: of.side,
        bound: Number(of.bound) / typedIn(unitOf(of.metric)).perSi,
        times: Number(of.times),
        last,
        ...basis,
      };
    case 'recognition':
      return { kind: of.kind, share: Number(of.share) / 100, level: Number(of.level) / 100, last, ...basis };
    case 'lc_cusum':
      return {
        kind: of.kind,
        adequate: Number(of.adequate) / 100,
        inadequate: Number(of.inadequate) / 100,
        ...basis,
      };
  }
}

export interface CaseChoice {
  /** "case ID", or "tuned NAME" for a built-in scenario. */
  readonly key: string;
  readonly title: string;
}

export interface StepDraft {
  readonly id: string;
  readonly name: string;
  readonly cases: readonly CaseChoice[];
  readonly repeats: string;
  readonly after: readonly string[];
  readonly requirements: readonly RequirementDraft[];
}

/** A step behind those that are there; it waits for the last of them. */
export function newStep(steps: readonly StepDraft[]): StepDraft {
  const taken = new Set(steps.map(({ id }) => id));
  let number = steps.length + 1;
  while (taken.has(`step-${number}`)) number += 1;
  const before = steps.at(-1);
  return {
    id: `step-${number}`,
    name: '',
    cases: [],
    repeats: '3',
    after: before ? [before.id] : [],
    requirements: [newRequirement('recognition')],
  };
}

/** Without a step, and without what waited for it. */
export const withoutStep = (steps: readonly StepDraft[], id: string): readonly StepDraft[] =>
  steps
    .filter((step) => step.id !== id)
    .map((step) => ({ ...step, after: step.after.filter((other) => other !== id) }));

export function stepProblem(step: StepDraft): string {
  if (step.name.trim() === '') return say('Name the step.');
  if (step.cases.length === 0) return say('Choose at least one case.');
  if (!isCount(step.repeats) || Number(step.repeats) > 20) return say('Enter 1 to 20 trials of each case.');
  if (step.requirements.length === 0) return say('Add the criteria of the step.');
  return step.requirements.map(requirementProblem).find((wrong) => wrong !== '') ?? '';
}

export function curriculumRequest(
  id: string | undefined,
  title: string,
  reason: string,
  steps: readonly StepDraft[],
  unitOf: (metric: string) => string,
): NewCurriculum {
  return {
    ...(id === undefined ? {} : { id }),
    title: title.trim(),
    ...(reason.trim() === '' ? {} : { reason: reason.trim() }),
    steps: steps.map((step) => ({
      id: step.id,
      name: step.name.trim(),
      cases: step.cases.map(({ key }) => {
        const name = key.slice(key.indexOf(' ') + 1);
        return key.startsWith('tuned ') ? { scenario: { tuned: name } } : { case: name };
      }) as NewCurriculum['steps'][number]['cases'], // the server checks the names of scenarios
      repeats: Number(step.repeats),
      after: [...step.after],
      criteria: { ...criteriaOf(step.requirements.map((one) => requestOf(one, unitOf))) },
    })),
  };
}
