import { useState } from 'react';
import type { CohortTable, MetricFacts } from '@/api';
import { say } from '@/language';
import { Button, Field, Select } from '@/ui';
import { formatCount } from '@/units';
import styles from './analysis.module.css';
import {
  columnName,
  defaultEndpoint,
  defaultPredictor,
  endpointsFor,
  predictorsFor,
  rowsWith,
  startFor,
} from './columns';
import { kMethods, type Method } from './methods';
import type { Question } from './plan-draft';

interface Props {
  readonly table: CohortTable;
  readonly metrics: readonly MetricFacts[];
  readonly action: string;
  readonly busy: boolean;
  /** In a plan: whether it is one of the tests that are corrected together. */
  readonly planned?: boolean;
  readonly onAsk: (question: Question) => void;
}

const kFirst: Method = {
  id: 'describe',
  name: '',
  description: '',
  formula: (endpoint) => `${endpoint} ~ 1`,
  people: false,
};

/** An analysis: endpoint, predictor and method. */
export function QuestionForm({ table, metrics, action, busy, planned = false, onAsk }: Props) {
  const [methodId, setMethod] = useState('lmm');
  const endpoints = endpointsFor(table, methodId);
  const predictors = predictorsFor(table, methodId);
  const [endpoint, setEndpoint] = useState(() => defaultEndpoint(table));
  const [by, setBy] = useState(() => defaultPredictor(table, endpoint));
  const [own, setOwn] = useState<string | null>(null);
  const [primary, setPrimary] = useState(true);
  const method = kMethods.find(({ id }) => id === methodId) ?? kFirst;
  const formula = own ?? method.formula(endpoint, by, 'participant');
  const change =
    <Value,>(set: (value: Value) => void) =>
    (value: Value) => {
      set(value);
      setOwn(null);
    };
  /** What the method and the endpoint cannot have is replaced by what they can. */
  const start = (nextMethod: string, nextEndpoint: string) => {
    const [end, predictor] = startFor(table, nextMethod, nextEndpoint, by);
    setMethod(nextMethod);
    setEndpoint(end);
    setBy(predictor);
    setOwn(null);
  };
  const usable = rowsWith(table, endpoint, method.id === 'describe' ? '1' : by);
  const question =
    method.id === 'describe'
      ? columnName(endpoint, metrics)
      : say('{endpoint} by {predictor}', {
          endpoint: columnName(endpoint, metrics),
          predictor: columnName(by, metrics),
        });
  return (
    <div className={styles.stack}>
      <div className={styles.fields}>
        <Select
          label={say('Endpoint')}
          value={endpoint}
          onChange={(event) => start(methodId, event.target.value)}
          options={endpoints.map(({ name }) => ({ value: name, text: columnName(name, metrics) }))}
        />
        <Select
          label={say('Predictor')}
          value={by}
          onChange={(event) => change(setBy)(event.target.value)}
          options={
            predictors.length === 0
              ? [{ value: '1', text: say('no predictor available') }]
              : predictors.map(({ name }) => ({ value: name, text: columnName(name, metrics) }))
          }
        />
        <Select
          label={say('Method')}
          value={methodId}
          onChange={(event) => start(event.target.value, endpoint)}
          options={kMethods.map(({ id, name }) => ({ value: id, text: say(name) }))}
        />
      </div>
      <p className={styles.muted}>
        {say(method.description)}{' '}
        {usable === 0
          ? say('No trial has both endpoint and predictor: choose another predictor.')
          : say('{usable} of {count} trials have the values that it needs.', {
              usable: formatCount(usable),
              count: formatCount(table.rows.length),
            })}
      </p>
      <div className={styles.ask}>
        <Field
          label={say('Formula (editable)')}
          value={formula}
          spellCheck={false}
          onChange={(event) => setOwn(event.target.value)}
        />
        {planned ? (
          <label className={styles.check}>
            <input type="checkbox" checked={primary} onChange={(event) => setPrimary(event.target.checked)} />{' '}
            {say('primary (included in the correction for multiple testing)')}
          </label>
        ) : null}
        <Button
          look="solid"
          disabled={busy || endpoint === '' || (own === null && usable === 0)}
          onClick={() => onAsk({ method: method.id, formula, question, primary })}
        >
          {busy ? say('Starting…') : action}
        </Button>
      </div>
    </div>
  );
}
