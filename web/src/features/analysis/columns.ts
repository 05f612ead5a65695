/** Columns of the trial data: which can be endpoints or predictors, and what they are called. Pure. */
import type { CohortTable, MetricFacts } from '@/api';
import { marked, say } from '@/language';

const kNames: Record<string, string | undefined> = {
  correct: marked('Correct answer'),
  experience_years: marked('Years of experience'),
  cohort: marked('Cohort'),
  level: marked('Level of training'),
  number: marked('Trial number in the study'),
  running_number: marked('Running trial number'),
  year: marked('Calendar date, years'),
  case: marked('Scenario or case'),
  participant: marked('Participant'),
  study: marked('Study'),
  rig: marked('Rig'),
};
const kNoEndpoints: readonly string[] = ['number', 'running_number', 'year', 'experience_years', 'simulated'];
const kPredictors: readonly string[] = [
  'cohort',
  'level',
  'running_number',
  'year',
  'experience_years',
  'number',
  'case',
  'rig',
];

type Column = CohortTable['columns'][number];

/** "Operation time, s (palpation)": label, unit, and the rig whose trials alone have the metric. */
function metricName({ label, unit, rig }: MetricFacts): string {
  return [say(label), unit === '1' || unit === '' ? '' : `, ${unit}`, rig === null ? '' : ` (${say(rig)})`].join('');
}

/** What a column is called; the id follows where two metrics would have the same name. */
export function columnName(name: string, metrics: readonly MetricFacts[]): string {
  const metric = metrics.find(({ id }) => id === name);
  if (kNames[name] !== undefined || !metric) return say(kNames[name] ?? name.replaceAll('_', ' '));
  const shown = metricName(metric);
  return metrics.filter((other) => metricName(other) === shown).length > 1 ? `${shown} [${name}]` : shown;
}

/** The name of an axis, which begins with that of a column. */
export const axisName = (label: string, metrics: readonly MetricFacts[]) =>
  label.replace(/^\w+/, (name) => columnName(name, metrics));

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
const kGroupMethods: readonly string[] = ['anova', 'rm-anova', 'rank', 'permutation', 'effect-size'];
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

/** The endpoint to begin with: the measure, else yes or no, that most rows have. */
export function defaultEndpoint(table: CohortTable): string {
  const all = endpointsOf(table),
    answers = endpointsFor(table, kYesNoMethod).map(({ name }) => name),
    measures = all.filter(({ name }) => !answers.includes(name));
  return (measures.length > 0 ? measures : all).reduce(
    (best, { name }) => (best === '' || rowsWith(table, name) > rowsWith(table, best) ? name : best),
    '',
  );
}

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

/** The cohorts in the table, by name. */
export const cohortsOf = ({ columns }: CohortTable): string[] =>
  [...(columns.find(({ name }) => name === 'cohort')?.levels ?? [])].sort((a, b) => a.localeCompare(b));

/** Persons and trials of a cohort that have the endpoint. */
export function sizeOf({ rows }: CohortTable, cohort: string, endpoint: string): { persons: number; trials: number } {
  const own = rows.filter((row) => row.cohort === cohort && isFilled(row, endpoint));
  return { persons: new Set(own.map(({ participant }) => participant)).size, trials: own.length };
}
