import { useState } from 'react';
import type { CohortTable, MetricFacts } from '@/api';
import { marked, say } from '@/language';
import { Button, Select, Term } from '@/ui';
import { formatCount } from '@/units';
import styles from './analysis.module.css';
import { cohortsOf, columnName, endpointsOf, sizeOf } from './columns';

export interface Comparison {
  readonly method: 'effect-size';
  readonly formula: string;
  readonly options: { readonly level: string; readonly reference: string };
}

const kTest = marked(
  'Welch’s t test on the mean of each person, because trials of one person are not independent; the size of the difference as Hedges’ g with its 95 % interval.',
);

/** Each person counts once, by the mean of their trials. */
export const comparison = (endpoint: string, level: string, reference: string): Comparison => ({
  method: 'effect-size',
  formula: `${endpoint} ~ cohort + (1|participant)`,
  options: { level, reference },
});

/** One cohort beside another, with the test chosen already. */
export function CompareForm({
  table,
  metrics,
  busy,
  onCompare,
}: {
  readonly table: CohortTable;
  readonly metrics: readonly MetricFacts[];
  readonly busy: boolean;
  readonly onCompare: (comparison: Comparison) => void;
}) {
  const cohorts = cohortsOf(table),
    endpoints = endpointsOf(table);
  const [level, setLevel] = useState(cohorts[0] ?? '');
  const [reference, setReference] = useState(cohorts[1] ?? '');
  const [endpoint, setEndpoint] = useState(
    (endpoints.find(({ name }) => name === 'correct') ?? endpoints[0])?.name ?? '',
  );
  if (cohorts.length < 2)
    return (
      <p className={styles.muted}>
        {say('Two cohorts with scored trials are needed.')}{' '}
        {cohorts[0] === undefined ? say('There is none yet.') : say('There is one: {name}.', { name: cohorts[0] })}{' '}
        {say('Trials belong to a cohort by their assignment, and their trainee has agreed to research.')}
      </p>
    );
  const options = cohorts.map((name) => ({ value: name, text: name }));
  const sizes = [level, reference].map((name) => ({ name, ...sizeOf(table, name, endpoint) }));
  const few = sizes.find(({ persons }) => persons < 2);
  return (
    <div className={styles.stack}>
      <div className={styles.fields}>
        <Select
          label={say('Cohort')}
          value={level}
          options={options}
          onChange={(event) => setLevel(event.target.value)}
        />
        <Select
          label={say('Compared with')}
          value={reference}
          options={options}
          onChange={(event) => setReference(event.target.value)}
        />
        <Select
          label={say('Endpoint')}
          value={endpoint}
          options={endpoints.map(({ name }) => ({ value: name, text: columnName(name, metrics) }))}
          onChange={(event) => setEndpoint(event.target.value)}
        />
      </div>
      <div className={styles.end}>
        <p className={styles.muted} role="status">
          {level === reference
            ? say('Choose two different cohorts.')
            : few
              ? say('{name} has fewer than two persons with this endpoint.', { name: few.name })
              : sizes
                  .map(({ name, persons, trials }) =>
                    say('{name}: {persons} persons, {trials} trials', {
                      name,
                      persons: formatCount(persons),
                      trials: formatCount(trials),
                    }),
                  )
                  .join(' · ')}
        </p>
        <Term align="end" definition={say(kTest)}>
          {say('Test')}
        </Term>
        <Button
          look="solid"
          disabled={busy || level === reference || few !== undefined}
          onClick={() => onCompare(comparison(endpoint, level, reference))}
        >
          {busy ? say('Starting…') : say('Compare')}
        </Button>
      </div>
    </div>
  );
}
