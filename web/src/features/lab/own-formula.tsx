import { useQuery } from '@tanstack/react-query';
import { useEffect, useId, useState } from 'react';
import { checkEffect, type EffectList, type OwnEffect, type Rig } from '@/api';
import { say, Sentence } from '@/language';
import { Button, Field, Scroll, useSettled } from '@/ui';
import styles from './lab.module.css';
import {
  kBlankOwn,
  mistypedStates,
  ownEffect,
  withFormula,
  withState,
  type OwnDraft,
  type OwnParameter,
} from './own-effect';

interface Props {
  readonly rig: Rig;
  readonly list: EffectList;
  readonly onOwn: (own: OwnEffect | null) => void;
}

const kPace_ms = 250;

function ParameterRow({
  parameter,
  set,
}: {
  readonly parameter: OwnParameter;
  readonly set: (changes: Partial<OwnParameter>) => void;
}) {
  const { name } = parameter;
  const cell = (key: 'unit' | 'initial' | 'low' | 'high', what: string) => (
    <td>
      <input
        aria-label={say('{property} of {parameter}', { property: what, parameter: name })}
        value={parameter[key]}
        spellCheck={false}
        inputMode={key === 'unit' ? 'text' : 'decimal'}
        onChange={(event) => set({ [key]: event.target.value })}
      />
    </td>
  );
  return (
    <tr>
      <th scope="row">
        <code>{name}</code>
      </th>
      {cell('unit', say('Unit'))}
      {cell('initial', say('Start value'))}
      {cell('low', say('Minimum'))}
      {cell('high', say('Maximum'))}
    </tr>
  );
}

/** A custom formula: its parameters are detected and its units are checked while it is typed. */
export function OwnFormula({ rig, list, onOwn }: Props) {
  const [draft, setDraft] = useState<OwnDraft>(kBlankOwn);
  const settled = useSettled(draft, kPace_ms);
  const own = ownEffect(settled, rig, list);
  const check = useQuery({
    queryKey: ['lab', 'check', own],
    queryFn: ({ signal }) => checkEffect(own ?? {}, signal),
    enabled: own !== null,
    staleTime: Infinity,
    retry: false,
  });
  const good = own !== null && check.data?.ok === true && settled === draft;
  useEffect(() => {
    onOwn(good ? own : null);
  }, [good, JSON.stringify(own)]); // eslint-disable-line react-hooks/exhaustive-deps -- the effect as a value
  const id = useId();
  const set = (name: string, changes: Partial<OwnParameter>) =>
    setDraft({
      ...draft,
      parameters: draft.parameters.map((one) => (one.name === name ? { ...one, ...changes } : one)),
    });
  const mistyped = mistypedStates(draft, list.states);
  const message =
    mistyped.length > 0
      ? say(
          'The units are checked once each name is clear: use the state variable, or give the parameter another name.',
        )
      : own === null
        ? say('The result must have the unit {unit}.', { unit: list.adds_unit })
        : check.isError
          ? check.error.message
          : settled !== draft || check.isPending
            ? say('Checking the units…')
            : check.data.ok
              ? say('✓ The units are consistent: the result has the unit {unit}.', { unit: list.adds_unit })
              : check.data.error;
  const wrong = own !== null && (check.isError || check.data?.ok === false);
  return (
    <div className={styles.own}>
      <div className={styles.ownHead}>
        <Field
          label={say('Name')}
          value={draft.name}
          maxLength={32}
          spellCheck={false}
          pattern="[a-z][a-z0-9_]*"
          onChange={(event) => setDraft({ ...draft, name: event.target.value })}
        />
        <Field
          label={say('Formula')}
          value={draft.formula}
          maxLength={500}
          spellCheck={false}
          placeholder={rig === 'probing' ? 'c * v_m_s * abs(v_m_s)' : 'mu * base_N'}
          aria-invalid={wrong}
          aria-describedby={id}
          onChange={(event) => setDraft(withFormula(draft, event.target.value, list.states))}
        />
      </div>
      <p id={id} role="status" className={wrong ? styles.wrong : styles.muted} data-part="unit-check">
        {message}
      </p>
      {mistyped.map(({ typed, state }) => (
        <p key={typed} className={styles.wrong} role="status">
          <Sentence
            text="<code>{typed}</code> would be fitted as a constant. The state variable is <code>{state}</code>."
            values={{ typed, state }}
            parts={{ code: (words) => <code>{words}</code> }}
          />{' '}
          <Button
            look="quiet"
            onClick={() => setDraft(withFormula(draft, withState(draft.formula, typed, state), list.states))}
          >
            {say('Use {state}', { state })}
          </Button>
        </p>
      ))}
      {draft.parameters.length > 0 ? (
        <Scroll label={say('Parameters of the formula')}>
          <table className={`${styles.table} ${styles.inputs}`}>
            <caption className="hidden-visually">{say('Parameters of the formula')}</caption>
            <thead>
              <tr>
                <th scope="col">{say('Parameter')}</th>
                <th scope="col">{say('Unit')}</th>
                <th scope="col">{say('Start value')}</th>
                <th scope="col">{say('Minimum')}</th>
                <th scope="col">{say('Maximum')}</th>
              </tr>
            </thead>
            <tbody>
              {draft.parameters.map((parameter) => (
                <ParameterRow
                  key={parameter.name}
                  parameter={parameter}
                  set={(changes) => set(parameter.name, changes)}
                />
              ))}
            </tbody>
          </table>
        </Scroll>
      ) : null}
      <details>
        <summary>{say('Names available in a formula')}</summary>
        <Scroll label={say('State variables')}>
          <table className={styles.table}>
            <caption className="hidden-visually">{say('State variables')}</caption>
            <thead>
              <tr>
                <th scope="col">{say('Name')}</th>
                <th scope="col">{say('Unit')}</th>
                <th scope="col">{say('Meaning')}</th>
              </tr>
            </thead>
            <tbody>
              {list.states.map((state) => (
                <tr key={state.name}>
                  <th scope="row">
                    <code>{state.name}</code>
                  </th>
                  <td>{state.unit}</td>
                  <td>{state.meaning}</td>
                </tr>
              ))}
            </tbody>
          </table>
        </Scroll>
        <p className={styles.muted}>
          <Sentence
            text="<code>+ - * / ^</code>, comparisons, <code>a ? b : c</code>, abs sqrt sign min max exp ln sin cos tan tanh pi. Any other name is a parameter and is fitted."
            parts={{ code: (words) => <code>{words}</code> }}
          />
        </p>
      </details>
    </div>
  );
}
