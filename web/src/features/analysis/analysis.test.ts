import { describe, expect, it } from 'vitest';
import type { MetricFacts } from '@/api';
import { tableOf } from '@/api/cohort-table';
import {
  axisName,
  cohortsOf,
  columnName,
  defaultEndpoint,
  defaultPredictor,
  endpointsFor,
  endpointsOf,
  predictorsFor,
  sizeOf,
  startFor,
} from './columns';
import { comparison } from './compare-form';
import { groupTicks, spanOf } from './figure-axes';
import { kMethods } from './methods';
import { kBlankPlan, planOf } from './plan-draft';
import { cell } from './report-view';

describe('the cohort’s table', () => {
  it('keeps commas, quotation marks and line breaks that stand in quotes', () => {
    const { rows } = tableOf(
      'trial,case,level,right\nt1,"In, out and in again",,1\nt2,"a ""hard"" case\nin bone",,0\n',
    );
    expect(rows).toEqual([
      { trial: 't1', case: 'In, out and in again', level: '', right: '1' },
      { trial: 't2', case: 'a "hard" case\nin bone', level: '', right: '0' },
    ]);
  });

  it('is refused where a quotation mark is missing', () => {
    expect(() => tableOf('trial,case\nt1,"Hard bone\n')).toThrow('row 1');
  });

  it('knows which columns are numbers, empty cells aside', () => {
    const { columns, rows } = tableOf('trial,level,time\na,novice,1.5\nb,senior,\n');
    expect(rows).toHaveLength(2);
    expect(columns.map(({ name, numbers }) => [name, numbers])).toEqual([
      ['trial', false],
      ['level', false],
      ['time', true],
    ]);
  });
});

describe('the columns', () => {
  const metric = (id: string, label: string, rig: MetricFacts['rig']): MetricFacts => ({
    id,
    label,
    unit: 's',
    definition: '',
    source: '',
    rig,
  });
  const table = tableOf(
    'trial,level,number,correct,answer_right,operation_time\na,novice,1,1,1,20\nb,,2,0,0,30\nc,senior,3,1,1,40\n',
  );

  it('are named with unit and rig, and with the id where that is not enough', () => {
    const metrics = [
      metric('operation_time', 'Operation time', 'palpation'),
      metric('probing_time', 'Operation time', 'probing'),
      metric('path', 'Path', null),
      metric('way', 'Path', null),
    ];
    const names = ['operation_time', 'probing_time', 'path', 'way', 'running_number', 'cohort'];
    expect(names.map((name) => columnName(name, metrics))).toEqual([
      'Operation time, s (palpation)',
      'Operation time, s (probing)',
      'Path, s [path]',
      'Path, s [way]',
      'Running trial number',
      'Cohort',
    ]);
    expect(new Set(names.map((name) => columnName(name, metrics))).size).toBe(names.length);
  });

  it('name an axis by the column that it begins with', () => {
    const metrics = [metric('operation_time', 'Operation time', 'palpation')];
    expect(axisName('operation_time, mean of each participant', metrics)).toBe(
      'Operation time, s (palpation), mean of each participant',
    );
    expect(axisName('standard normal quantile', metrics)).toBe('standard normal quantile');
  });

  it('list the correctness of the answer once among the endpoints', () => {
    expect(endpointsOf(table).map(({ name }) => name)).toEqual(['correct', 'operation_time']);
  });

  it('begin with the predictor that most rows have', () => {
    expect(defaultPredictor(table, 'operation_time')).toBe('number');
    expect(defaultPredictor(tableOf('trial,operation_time\na,20\n'), 'operation_time')).toBe('1');
  });
});

describe('the start of a method', () => {
  // Two trials have a level, none of them a path; all have a rig.
  const table = tableOf(
    'trial,level,number,rig,correct,path,time\na,novice,1,probing,1,,20\nb,senior,2,probing,0,,30\nc,,3,palpation,1,0.2,40\nd,,4,palpation,,0.3,50\n',
  );

  it('offers groups to a comparison of groups, and yes or no to a logistic regression', () => {
    expect(predictorsFor(table, 'anova').map(({ name }) => name)).toEqual(['level', 'rig']);
    expect(predictorsFor(table, 'ols').map(({ name }) => name)).toEqual(['level', 'number', 'rig']);
    expect(endpointsFor(table, 'logistic').map(({ name }) => name)).toEqual(['correct']);
  });

  it('begins with the measure that most trials have, and with right and wrong where there is no other', () => {
    const part = tableOf('trial,correct,path,time\na,1,0.2,\nb,0,,20\nc,1,,30\n');
    expect(defaultEndpoint(part)).toBe('time');
    expect(defaultEndpoint(tableOf('trial,level,correct\na,x,1\nb,y,0\n'))).toBe('correct');
    expect(defaultEndpoint(tableOf('trial,level\na,x\n'))).toBe('');
  });

  it('keeps what was chosen where there are rows, and else takes what has most', () => {
    expect(startFor(table, 'anova', 'time', 'level')).toEqual(['time', 'level']);
    expect(startFor(table, 'anova', 'path', 'level')).toEqual(['path', 'rig']);
    expect(startFor(table, 'anova', 'time', 'number')).toEqual(['time', 'rig']);
    expect(startFor(table, 'logistic', 'time', 'level')).toEqual(['correct', 'level']);
  });
});

describe('a comparison of cohorts', () => {
  const table = tableOf(
    'trial,participant,cohort,running_number,year,date,correct\na,P1,Residents,1,2026.1,2026-02-06,1\nb,P1,Residents,2,2026.2,2026-03-15,0\nc,P2,Fellows,1,2026.1,2026-02-06,\nd,P3,,1,2026.3,2026-04-20,1\n',
  );

  it('knows the cohorts, and who of them has the endpoint', () => {
    expect(cohortsOf(table)).toEqual(['Fellows', 'Residents']);
    expect(sizeOf(table, 'Residents', 'correct')).toEqual({ persons: 1, trials: 2 });
    expect(sizeOf(table, 'Fellows', 'correct')).toEqual({ persons: 0, trials: 0 });
  });

  it('counts each person once and names both cohorts', () => {
    expect(comparison('correct', 'Fellows', 'Residents')).toEqual({
      method: 'effect-size',
      formula: 'correct ~ cohort + (1|participant)',
      options: { level: 'Fellows', reference: 'Residents' },
    });
  });

  it('has cohort, running number and calendar date as predictors, and none of them as an endpoint', () => {
    expect(predictorsFor(table, 'lmm').map(({ name }) => name)).toEqual(['cohort', 'running_number', 'year']);
    expect(predictorsFor(table, 'anova').map(({ name }) => name)).toEqual(['cohort']);
    expect(endpointsOf(table).map(({ name }) => name)).toEqual(['correct']);
  });
});

it('the axis of a figure holds all numbers and a margin, gaps left out', () => {
  expect(spanOf([[1, null, 3], [2]], 0.5)).toEqual({ from: 0, to: 4 });
  expect(spanOf([[null]], 0.5)).toEqual({ from: 0, to: 1 });
});

it('groups are named on the axis where the names have room, else numbered', () => {
  expect(groupTicks(['Fellows', 'Residents'])).toEqual([
    { at: 1, text: 'Fellows' },
    { at: 2, text: 'Residents' },
  ]);
  const long = 'a cohort with a name that takes a third of the axis';
  expect(groupTicks([long, 'Residents']).map(({ text }) => text)).toEqual(['1', '2']);
});

describe('a plan', () => {
  const question = {
    method: 'lmm',
    formula: 'operation_time ~ level + (1|participant)',
    question: 'Operation time by level',
    primary: true,
  };

  it('says what is missing, one thing at a time', () => {
    expect(planOf(kBlankPlan)).toEqual({ missing: 'Enter a title.' });
    expect(planOf({ ...kBlankPlan, title: 'x', endpoint: 'operation_time' })).toEqual({
      missing: 'Add at least one analysis.',
    });
    expect(planOf({ ...kBlankPlan, title: 'x', endpoint: 'a', questions: [question], alpha: '2' })).toEqual({
      missing: 'α must be greater than 0 and less than 0.5.',
    });
  });

  it('goes out as tractus-plan/1 with its primary family', () => {
    const made = planOf({
      ...kBlankPlan,
      title: ' x ',
      endpoint: 'operation_time',
      questions: [question, { ...question, primary: false }],
    });
    expect(made).toMatchObject({
      plan: {
        format: 'tractus-plan/1',
        title: 'x',
        alpha: 0.05,
        correction: 'holm',
        exclusions: [],
        analyses: [{ id: 'analysis-1', family: 'primary', method: 'lmm' }, { id: 'analysis-2' }],
      },
    });
  });

  it('has the person as a random intercept wherever trials repeat', () => {
    const lmm = kMethods.find(({ id }) => id === 'lmm');
    expect(lmm?.formula('t', 'level', 'participant')).toBe('t ~ level + (1|participant)');
  });
});

describe('a number of a report', () => {
  it.each([
    [0.0000231, 'p', 'p < 0.001'],
    [0.38909, 'p', '0.389'],
    [8, 'df', '8'],
    [null, 'p', '–'],
    [true, 'x', 'yes'],
  ])('%s as %s reads %s', (value, key, text) => {
    expect(cell(value, key)).toBe(text);
  });
});
