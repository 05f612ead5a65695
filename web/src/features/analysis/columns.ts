/** Columns of the trial data: which can be endpoints or predictors, and what they are called. Pure. */
import type { CohortTable, MetricFacts } from '@/api';

const kNames: Record<string, string | undefined> = {
  correct: 'Correct answer',
  experience_years: 'Years of experience',
  level: 'Level of training',
  number: 'Trial number',
  case: 'Scenario or case',
  participant: 'Participant',
  study: 'Study',
  rig: 'Rig',
};
const kNoEndpoints: readonly string[] = ['number', 'experience_years', 'simulated'];
const kPredictors: readonly string[] = ['experience_years', 'level', 'number', 'case', 'rig'];

type Column = CohortTable['columns'][number];

const plainName = (name: string, metrics: readonly MetricFacts[]) =>
  kNames[name] ?? metrics.find(({ id }) => id === name)?.label ?? name.replaceAll('_', ' ');

/** Metrics of the two rigs may have the same label: then the id follows in brackets. */
export function columnName(name: string, metrics: readonly MetricFacts[]): string {
  const label = plainName(name, metrics);
  return metrics.filter((metric) => metric.label === label).length > 1 ? `${label} (${name})` : label;
}

/** Columns of numbers. The metric answer_right is left out where the column "correct" has the same values. */
export function endpointsOf({ columns }: CohortTable): Column[] {
  const judged = columns.some(({ name }) => name === 'correct');
  return columns.filter(
    ({ name, numbers }) => numbers && !kNoEndpoints.includes(name) && !(judged && name === 'answer_right'),
  );
}

export const predictorsOf = ({ columns }: CohortTable): Column[] =>
  columns.filter(({ name, levels }) => kPredictors.includes(name) && levels.length > 1);

/** Methods that compare groups, and the method whose endpoint is a yes or no. */
const kGroupMethods: readonly string[] = ['anova', 'rm-anova', 'rank', 'permutation'];
const kYesNoMethod = 'logistic';

const isFilled = (row: CohortTable['rows'][number], name: string) => (row[name] ?? '') !== '';

/** Rows that have all of these columns. */
export const rowsWith = ({ rows }: CohortTable, ...names: string[]) =>
  rows.filter((row) => names.every((name) => name === '1' || isFilled(row, name))).length;

/** The endpoints that a method can analyse. */
export const endpointsFor = (table: CohortTable, method: string): Column[] =>
  endpointsOf(table).filter(
    ({ name }) => method !== kYesNoMethod || table.rows.every((row) => ['', '0', '1'].includes(row[name] ?? '')),
  );

/** The predictors that a method can use: groups where it compares groups. */
export const predictorsFor = (table: CohortTable, method: string): Column[] =>
  predictorsOf(table).filter(({ numbers }) => !numbers || !kGroupMethods.includes(method));

/** The endpoint and predictor to begin with for a method: what was chosen, if the method can use it and there are rows. */
export function startFor(table: CohortTable, method: string, endpoint: string, by: string): [string, string] {
  const endpoints = endpointsFor(table, method),
    predictors = predictorsFor(table, method);
  const found = endpoints.find(({ name }) => name === endpoint) ?? endpoints[0];
  const name = found?.name ?? endpoint;
  const kept = predictors.find((one) => one.name === by && rowsWith(table, name, by) > 0);
  return [name, kept?.name ?? defaultPredictor(table, name, predictors)];
}

/** The predictor that most rows with the endpoint have; '1' where there is none. */
export function defaultPredictor(table: CohortTable, endpoint: string, among = predictorsOf(table)): string {
  const rows = (name: string) => rowsWith(table, endpoint, name);
  return among.reduce((best, { name }) => (best === '1' || rows(name) > rows(best) ? name : best), '1');
}
