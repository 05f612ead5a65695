import { expect, it } from 'vitest';
import {
  curriculumRequest,
  draftOf,
  newRequirement,
  newStep,
  requestOf,
  requirementProblem,
  stepProblem,
  withoutStep,
} from './draft';

const inMetres = () => 'm';

it('sends a bound in SI and shows it in millimetres', () => {
  const draft = { ...newRequirement('metric', 'path_length'), bound: '62.5', times: '2', last: '' };
  const sent = requestOf(draft, inMetres);
  expect(sent).toEqual({
    kind: 'metric',
    metric: 'path_length',
    side: 'at_most',
    bound: 0.0625,
    times: 2,
    last: 0,
  });
  const { key, ...back } = draftOf({ ...sent, kind: 'metric', basis: '', text: '' } as never, inMetres);
  expect(key).toBeGreaterThan(0);
  expect(back).toMatchObject({ bound: '62.5', times: '2', last: '' });
});

it('sends percentages as shares', () => {
  expect(requestOf(newRequirement('lc_cusum'), inMetres)).toEqual({
    kind: 'lc_cusum',
    adequate: 0.1,
    inadequate: 0.25,
  });
  expect(requestOf(newRequirement('recognition'), inMetres)).toEqual({
    kind: 'recognition',
    share: 0.8,
    level: 0.95,
    last: 0,
  });
});

it.each([
  [{ ...newRequirement('metric', 'operation_time'), bound: '' }, 'number'],
  [{ ...newRequirement('metric', 'operation_time'), bound: '4', times: '6' }, 'More trials'],
  [{ ...newRequirement('metric'), bound: '4' }, 'metric'],
  [{ ...newRequirement('recognition'), share: '100' }, 'between'],
  [{ ...newRequirement('lc_cusum'), adequate: '30' }, 'below'],
])('names what is wrong with %o', (draft, words) => {
  expect(requirementProblem(draft)).toContain(words);
});

it('lets a new step wait for the one before, and for nothing that was removed', () => {
  const one = newStep([]),
    two = newStep([one]);
  expect(one.after).toEqual([]);
  expect(two.after).toEqual([one.id]);
  const [left] = withoutStep([one, two], one.id);
  expect(left?.after).toEqual([]);
  expect(left && newStep([left]).id).not.toBe(left?.id);
});

it('asks for a step’s name, its cases and its criteria', () => {
  const step = newStep([]);
  expect(stepProblem(step)).toContain('Name');
  const named = { ...step, name: 'Walls' };
  expect(stepProblem(named)).toContain('case');
  const full = {
    ...named,
    cases: [
      { key: 'tuned hard', title: 'Hard' },
      { key: 'case abc', title: 'L3' },
    ],
  };
  expect(stepProblem(full)).toBe('');
  expect(stepProblem({ ...full, requirements: [] })).toContain('criteria');
  expect(curriculumRequest('q', ' Year 1 ', '', [full], inMetres)).toMatchObject({
    id: 'q',
    title: 'Year 1',
    steps: [{ cases: [{ scenario: { tuned: 'hard' } }, { case: 'abc' }], repeats: 3 }],
  });
});
