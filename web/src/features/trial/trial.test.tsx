// @vitest-environment jsdom
import { cleanup, render, screen, within } from '@testing-library/react';
import { afterEach, describe, expect, it } from 'vitest';
import type { Answer, Metric, Scenario } from '@/api';
import { metre, share } from '@/units';
import { breachMarks } from './breaches';
import { channelOf } from './channel';
import { judge, judgeProbing } from './judgement';
import { arranged, shown } from './measure-rows';
import { Measures } from './measures';
import { seriesAddress } from './study-position';

afterEach(cleanup);

const answer = (changes: Partial<Answer>): Answer => ({
  breach: true,
  wall: 'medial',
  confidence: share(0.8),
  depth_m: null,
  ...changes,
});
const metric = (id: string, value: number | null, unit = 'N', more: Partial<Metric> = {}): Metric => ({
  id,
  label: `label of ${id}`,
  unit,
  value,
  note: '',
  definition: `definition of ${id}`,
  source: 'paper',
  shown_as: 'number',
  cell: null,
  ...more,
});
const inTable = (row: string, symbol: string, column: string) => ({ cell: { row, symbol, column } });

it('the link of a trial leads to its study, or to its assignment', () => {
  expect(seriesAddress('spine-study')).toBe('/studies/spine-study');
  expect(seriesAddress('a-0f3')).toBe('/assignments/a-0f3');
});

describe('the judgement', () => {
  it.each([
    ['both name the wall', answer({}), { breached: 'medial' }, 'correct', 'Correct'],
    ['both say intact', answer({ breach: false, wall: null }), { breached: null }, 'correct', 'Correct'],
    ['another wall was named', answer({ wall: 'lateral' }), { breached: 'medial' }, 'incorrect', 'in another wall'],
    ['no wall was named', answer({ wall: null }), { breached: 'medial' }, 'incorrect', 'no wall was named'],
    ['the breach was missed', answer({ breach: false, wall: null }), { breached: 'inferior' }, 'incorrect', 'missed'],
    ['there is no breach', answer({}), { breached: null }, 'incorrect', 'where there is none'],
  ] as const)('when %s', (_, said, truth, outcome, words) => {
    const judged = judge(said, truth);
    expect(judged.outcome).toBe(outcome);
    expect(judged.headline).toContain(words);
  });

  it('stays open without an answer or without the truth', () => {
    expect(judge(null, { breached: null }).headline).toBe('No answer');
    expect(judge(answer({}), null)).toMatchObject({ outcome: 'open', truth: 'Not released for this trial.' });
  });
});

describe('the channel that a burr made', () => {
  const drilled = (beyond: number | null, note: string) => [
    metric('drilled_volume', 5.6e-8, 'm^3'),
    metric('channel_breach', beyond, 'm', { note }),
    metric('channel_angle', null, 'rad', { note: 'too short' }),
  ];
  it.each([
    [0.0021, 'through the medial wall', 'out', 'Left the bone, through the medial wall, by 2.1 mm'],
    [
      -0.0014,
      'nearest to the inferior wall',
      'within',
      'Within the bone: 1.4 mm of bone remains, nearest to the inferior wall',
    ],
    [
      null,
      'the channel came to no place with a known wall',
      'unknown',
      'Not assessed: the channel came to no place with a known wall',
    ],
  ] as const)('reaching %s m beyond the bone', (beyond, note, outcome, words) => {
    const channel = channelOf(drilled(beyond, note));
    expect(channel?.outcome).toBe(outcome);
    expect(channel?.headline.replaceAll('\u202f', ' ')).toBe(words);
    expect(channel?.removed.replaceAll('\u202f', ' ')).toBe('56.0 mm³');
    expect(channel?.direction).toBe('–');
  });

  it('is of no trial that palpated', () => {
    expect(channelOf([metric('force_xy_mean', 0.1)])).toBeNull();
  });
});

const scenario = (walls: number[]): Scenario => ({
  id: 'x',
  name: 'bone',
  travel_m: metre(0.04),
  layers: [],
  walls: walls.map((at) => ({
    position_m: metre(at),
    resistance_interval_m: metre(0.006),
    breach_interval_m: metre(0.008),
  })),
});

describe('the judgement of a probing trial', () => {
  it.each([
    ['both say breach', answer({ wall: null, depth_m: metre(0.0212) }), scenario([0.02]), 'correct', 'Correct'],
    ['both say none', answer({ breach: false, wall: null }), scenario([]), 'correct', 'Correct'],
    ['it was missed', answer({ breach: false, wall: null }), scenario([0.02]), 'incorrect', 'missed'],
    ['there is none', answer({ wall: null }), scenario([]), 'incorrect', 'where there is none'],
  ] as const)('when %s', (_, said, truth, outcome, words) => {
    const judged = judgeProbing(said, truth);
    expect(judged.outcome).toBe(outcome);
    expect(judged.headline).toContain(words);
  });

  it('gives the reported depth and the depth of the wall', () => {
    const { given, truth } = judgeProbing(answer({ wall: null, depth_m: metre(0.0212) }), scenario([0.02]));
    expect(given.replaceAll('\u202f', ' ')).toContain('A breach at 21.2 mm.');
    expect(truth.replaceAll('\u202f', ' ')).toContain('breach at 20.0 mm');
  });
});

it('the moments of a breach are the entries into soft tissue from before it, not those back into it from behind', () => {
  const mode = ['bone', 'breach', 'bone', 'breach', 'bone', 'breach'] as const;
  const depth_m = [0.019, 0.021, 0.0281, 0.0279, 0.035, 0.036];
  expect(breachMarks({ t_s: [0, 1, 2, 3, 4, 5], depth_m, force_N: [], mode: [...mode] }).map(({ t_s }) => t_s)).toEqual(
    [1, 5],
  );
  expect(breachMarks(undefined)).toEqual([]);
});

describe('the measures', () => {
  const metrics = [
    metric('force_xy_mean', 0.28, 'N', inTable('Transverse force', 'F_xy', 'Mean')),
    metric('force_xy_max', 1.12, 'N', inTable('Transverse force', 'F_xy', 'Max')),
    metric('force_xy_sd', 0.24, 'N', inTable('Transverse force', 'F_xy', 'SD')),
    metric('path_length', 0.863, 'm'),
    metric('torque_z_sd', 0.0004, 'N·m', inTable('Twisting torque', 'T_z', 'SD')),
  ];

  it('stand in the published layout, and what is not in it follows in order', () => {
    const { statistics, rows, others } = arranged(metrics);
    expect(statistics).toEqual(['Mean', 'SD', 'Max']);
    expect(rows[0]?.cells.map((cell) => cell?.value)).toEqual([0.28, 0.24, 1.12]);
    expect(rows[1]?.cells.map((cell) => cell?.value)).toEqual([undefined, 0.0004, undefined]);
    expect(others.map(({ id }) => id)).toEqual(['path_length']);
  });

  it('read in the table as the paper prints them', () => {
    render(<Measures metrics={metrics} state="assessed" />);
    const row = screen.getByRole('row', { name: /Transverse force/ });
    // Basel paper, Table 1, surgeon 1.
    expect(
      within(row)
        .getAllByRole('cell')
        .map((cell) => within(cell).queryByRole('button')?.textContent ?? cell.textContent),
    ).toEqual(['N', '0.28', '0.24', '1.12']);
    expect(screen.getByRole('row', { name: /Twisting torque/ }).textContent).toContain('0.001');
  });

  it('give their definition to a screen reader', () => {
    render(<Measures metrics={metrics} state="assessed" />);
    const term = screen.getByRole('button', { name: '0.28' });
    const described = document.getElementById(term.getAttribute('aria-describedby') ?? '');
    expect(described?.textContent).toContain('definition of force_xy_mean');
  });

  it('that are shares read in per cent, a judgement as a word, a missing one as a dash', () => {
    expect(shown(metric('contact_share', 0.44, '1', { shown_as: 'share' })).replace('\u202f', ' ')).toBe('44 %');
    expect(shown(metric('wall_coverage_medial', 0.4667, '1', { shown_as: 'share' })).replace('\u202f', ' ')).toBe(
      '47 %',
    );
    expect(shown(metric('answer_right', 0, '1', { shown_as: 'correct_or_incorrect' }))).toBe('incorrect');
    expect(shown(metric('answer_right', null, '1', { shown_as: 'correct_or_incorrect' }))).toBe('–');
    expect(shown(metric('late_ticks', 3, '1'))).toBe('3');
  });

  it('are said to be missing where there are none', () => {
    render(<Measures metrics={[]} state="failed" />);
    expect(screen.getByText('This trial has no measures.')).toBeTruthy();
  });
});
