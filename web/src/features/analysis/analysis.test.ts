import { describe, expect, it } from 'vitest';
import type { MetricFacts } from '@/api';
import { tableOf } from '@/api/cohort-table';
import { columnName, defaultPredictor, endpointsFor, endpointsOf, predictorsFor, startFor } from './columns';
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
  const metric = (id: string, label: string): MetricFacts => ({ id, label, unit: 's', definition: '', source: '' });
  const table = tableOf(
    'trial,level,number,correct,answer_right,operation_time\na,novice,1,1,1,20\nb,,2,0,0,30\nc,senior,3,1,1,40\n',
  );

  it('have the id in the name where two metrics share a label', () => {
    const metrics = [
      metric('operation_time', 'Operation time'),
      metric('probing_time', 'Operation time'),
      metric('path', 'Path'),
    ];
    expect(['operation_time', 'probing_time', 'path'].map((name) => columnName(name, metrics))).toEqual([
      'Operation time (operation_time)',
      'Operation time (probing_time)',
      'Path',
    ]);
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

  it('keeps what was chosen where there are rows, and else takes what has most', () => {
    expect(startFor(table, 'anova', 'time', 'level')).toEqual(['time', 'level']);
    expect(startFor(table, 'anova', 'path', 'level')).toEqual(['path', 'rig']);
    expect(startFor(table, 'anova', 'time', 'number')).toEqual(['time', 'rig']);
    expect(startFor(table, 'logistic', 'time', 'level')).toEqual(['correct', 'level']);
  });
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
