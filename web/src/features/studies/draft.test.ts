import { describe, expect, it } from 'vitest';
import { idOf, kBlank, participantsOf, studyOf, type Draft } from './draft';

const draft = (changes: Partial<Draft>): Draft => ({ ...kBlank, title: 'Spine study', ...changes });

describe('participants written one a line', () => {
  it('are read with level, years and simulation in any order', () => {
    const { participants, faults } = participantsOf('P01, resident, 0.5\n\n P02 , 6 , senior\nS03, simulated');
    expect(faults).toEqual([]);
    expect(participants).toEqual([
      { name: 'P01', level: 'resident', experience_years: 0.5 },
      { name: 'P02', level: 'senior', experience_years: 6 },
      { name: 'S03', simulated: true },
    ]);
  });

  it('may hold commas, quotation marks and line breaks in quoted cells', () => {
    expect(participantsOf('P01,"resident, ""senior""",0.5\nP02,"fellow\nabroad"\n')).toEqual({
      faults: [],
      participants: [
        { name: 'P01', level: 'resident, "senior"', experience_years: 0.5 },
        { name: 'P02', level: 'fellow\nabroad' },
      ],
    });
  });

  it.each([
    ['P1,"resident', 'quotation mark'],
    ['Dr Smith, senior', 'not a valid pseudonym'],
    ['P1, 100', '0 to 80'],
    ['P1, a, b', 'expected pseudonym, level, years'],
    ['P1\nP1', 'listed twice'],
  ])('%s is told to be wrong: %s', (text, words) => {
    expect(participantsOf(text).faults[0]).toContain(words);
  });
});

describe('a study', () => {
  it('gets its short name from its title, and keeps one that was typed', () => {
    expect(idOf('Étude n° 3, rachis')).toBe('etude-n-3-rachis');
    expect(studyOf(draft({}))).toMatchObject({
      study: { id: 'spine-study', repeats: 3, ordering: 'random', on_invalid: 'at_end' },
    });
    expect(studyOf(draft({ id: 'own' }))).toMatchObject({ study: { id: 'own' } });
  });

  it('carries the tuned scenarios by name and uploaded ones whole', () => {
    const scenario = { format: 'tractus-scenario/1', name: 'mine' };
    expect(studyOf(draft({ tuned: ['hard'], uploaded: [{ file: 'a.json', scenario }] }))).toMatchObject({
      study: { scenarios: [{ tuned: 'hard' }, scenario] },
    });
  });

  it.each([
    [{ title: ' ' }, 'title'],
    [{ id: 'Not A Name' }, 'short name'],
    [{ tuned: [] }, 'scenarios'],
    [{ repeats: '0' }, 'repeated'],
    [{ repeats: '1.5' }, 'repeated'],
  ] satisfies [Partial<Draft>, string][])('with %o is not made, and says what is missing', (changes, words) => {
    const read = studyOf(draft(changes));
    expect('faults' in read ? read.faults.join(' ') : '').toContain(words);
  });
});
