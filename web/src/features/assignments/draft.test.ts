import { describe, expect, it } from 'vitest';
import { kNoDraft, lacking, letters, toggled, wishOf, type Draft, type Item } from './draft';

const l3: Item = { key: 'case l3', title: 'L3, medial', rig: 'palpation', case_id: 'c3' };
const hard: Item = { key: 'tuned hard', title: 'hard', rig: 'probing', tuned: 'hard' };
const both: Draft = { ...toggled(toggled(kNoDraft, l3), hard), title: ' Week 1 ', cohort: 'r27' };

describe('a new assignment', () => {
  it('gives each case a blind name of its own, also after one was taken out', () => {
    expect(both.chosen.map(({ blind }) => blind)).toEqual(['Case A', 'Case B']);
    expect(toggled(toggled(both, l3), l3).chosen.map(({ blind }) => blind)).toEqual(['Case B', 'Case A']);
  });
  it('counts on after Z', () => { expect([25, 26, 51, 52].map(letters)).toEqual(['Z', 'AA', 'AZ', 'BA']); });
  it('tells the server nothing of a title of a case, and the tuned scenario by its kind', () => {
    expect(wishOf(both)).toEqual({
      title: 'Week 1', cases: [{ case: 'c3', name: 'Case A' }, { scenario: { tuned: 'hard' }, name: 'Case B' }], cohort: 'r27', ordering: 'random', repeats: 1, release: 'held',
    });
  });
  it('says what it lacks', () => {
    expect(lacking({ ...both, title: '' })).toMatch(/title/);
    expect(lacking({ ...both, chosen: [] })).toMatch(/case/);
    expect(lacking({ ...both, cohort: '' })).toMatch(/cohort/);
    expect(lacking({ ...both, chosen: both.chosen.map((one) => ({ ...one, blind: 'Case A' })) })).toMatch(/same blind name/);
    expect(lacking(both)).toBe('');
  });
});
