import { describe, expect, it } from 'vitest';
import { kNoDraft, firstProblem, letters, toggled, requestOf, type Draft, type Item } from './draft';

const l3: Item = { key: 'case l3', title: 'L3, medial', rig: 'palpation', case_id: 'c3' };
const hard: Item = { key: 'tuned hard', title: 'hard', rig: 'probing', tuned: 'hard' };
const both: Draft = { ...toggled(toggled(kNoDraft, l3), hard), title: ' Week 1 ', cohort: 'r27' };

const kNow_us = new Date('2026-03-01T12:00').getTime() * 1000;

describe('a new assignment', () => {
  it('gives each case a blind name of its own, also after one was taken out', () => {
    expect(both.chosen.map(({ blind }) => blind)).toEqual(['Case A', 'Case B']);
    expect(toggled(toggled(both, l3), l3).chosen.map(({ blind }) => blind)).toEqual(['Case B', 'Case A']);
  });
  it('counts on after Z', () => {
    expect([25, 26, 51, 52].map(letters)).toEqual(['Z', 'AA', 'AZ', 'BA']);
  });
  it('tells the server nothing of a title of a case, and the tuned scenario by its kind', () => {
    expect(requestOf(both)).toEqual({
      title: 'Week 1',
      cases: [
        { case: 'c3', name: 'Case A' },
        { scenario: { tuned: 'hard' }, name: 'Case B' },
      ],
      cohort: 'r27',
      ordering: 'random',
      repeats: 1,
      release: 'held',
    });
  });
  it('says what it lacks', () => {
    expect(firstProblem({ ...both, title: '' }, kNow_us)).toMatch(/title/);
    expect(firstProblem({ ...both, chosen: [] }, kNow_us)).toMatch(/case/);
    expect(firstProblem({ ...both, cohort: '' }, kNow_us)).toMatch(/cohort/);
    expect(firstProblem({ ...both, chosen: both.chosen.map((one) => ({ ...one, blind: 'Case A' })) }, kNow_us)).toMatch(
      /same blind name/,
    );
    expect(firstProblem({ ...both, due: '2026-02-28T12:00' }, kNow_us)).toBe('The due date is in the past.');
    expect(firstProblem({ ...both, due: '2026-03-02T12:00' }, kNow_us)).toBe('');
    expect(firstProblem(both, kNow_us)).toBe('');
  });
});
