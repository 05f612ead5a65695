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

/** The predictor that most rows with the endpoint have; '1' where there is none. */
export function defaultPredictor(table: CohortTable, endpoint: string): string {
  const rowsWith = (name: string) =>
    table.rows.filter((row) => (row[endpoint] ?? '') !== '' && (row[name] ?? '') !== '').length;
  return predictorsOf(table).reduce(
    (best, { name }) => (best === '1' || rowsWith(name) > rowsWith(best) ? name : best),
    '1',
  );
}
