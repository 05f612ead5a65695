import { useState } from 'react';
import { marked, say } from '@/language';
import { Button, Field, Select } from '@/ui';
import { typedIn } from '@/units';
import styles from './criteria.module.css';
import { newRequirement, requirementProblem, type Kind, type RequirementDraft } from './draft';
import { ExpertBound } from './expert-bound';
import { useMetrics } from './parts';

type Change = (change: Partial<RequirementDraft>) => void;

function MetricFields({ draft, change }: { readonly draft: RequirementDraft; readonly change: Change }) {
  const { metrics, unitOf } = useMetrics();
  const [asking, setAsking] = useState(false);
  const unit = unitOf(draft.metric);
  const shown = typedIn(unit).unit;
  const label = say(metrics.find(({ id }) => id === draft.metric)?.label ?? '');
  return (
    <>
      <div className={styles.form}>
        <Select
          label={say('Metric')}
          value={draft.metric}
          onChange={(event) => change({ metric: event.target.value, bound: '', basis: '' })}
          options={[
            { value: '', text: say('Choose a metric') },
            ...metrics.map(({ id, label: text }) => ({ value: id, text: say(text) })),
          ]}
        />
        <Select
          label={say('Passes')}
          value={draft.side}
          onChange={(event) => change({ side: event.target.value === 'at_least' ? 'at_least' : 'at_most' })}
          options={[
            { value: 'at_most', text: say('at most') },
            { value: 'at_least', text: say('at least') },
          ]}
        />
        <Field
          label={shown === '' ? say('Bound') : say('Bound, {shown}', { shown })}
          inputMode="decimal"
          value={draft.bound}
          onChange={(event) => change({ bound: event.target.value, basis: '' })}
        />
        <Field
          label={say('Trials that must meet it')}
          inputMode="numeric"
          value={draft.times}
          onChange={(event) => change({ times: event.target.value })}
        />
        <Field
          label={say('Among the last trials (empty: all)')}
          inputMode="numeric"
          value={draft.last}
          onChange={(event) => change({ last: event.target.value })}
        />
      </div>
      {draft.basis === '' ? null : <p className={styles.basis}>{draft.basis}</p>}
      {draft.metric === '' ? null : (
        <Button look="quiet" onClick={() => setAsking(!asking)}>
          {asking ? say('Close experts’ trials') : say('Take the bound from experts’ trials…')}
        </Button>
      )}
      {asking ? (
        <ExpertBound
          key={`${draft.metric} ${draft.side}`}
          draft={draft}
          unit={unit}
          label={label}
          onBound={(bound, basis) => {
            change({ bound, basis });
            setAsking(false);
          }}
        />
      ) : null}
    </>
  );
}

function RecognitionFields({ draft, change }: { readonly draft: RequirementDraft; readonly change: Change }) {
  return (
    <div className={styles.form}>
      <Field
        label={say('Correct answers at least, %')}
        inputMode="decimal"
        value={draft.share}
        onChange={(event) => change({ share: event.target.value })}
      />
      <Field
        label={say('Confidence level of the interval, %')}
        inputMode="decimal"
        value={draft.level}
        onChange={(event) => change({ level: event.target.value })}
      />
      <Field
        label={say('Among the last answers (empty: all)')}
        inputMode="numeric"
        value={draft.last}
        onChange={(event) => change({ last: event.target.value })}
      />
    </div>
  );
}

function RateFields({ draft, change }: { readonly draft: RequirementDraft; readonly change: Change }) {
  return (
    <div className={styles.form}>
      <Field
        label={say('Acceptable failure rate, %')}
        inputMode="decimal"
        value={draft.adequate}
        onChange={(event) => change({ adequate: event.target.value })}
      />
      <Field
        label={say('Unacceptable failure rate, %')}
        inputMode="decimal"
        value={draft.inadequate}
        onChange={(event) => change({ inadequate: event.target.value })}
      />
    </div>
  );
}

const kKinds: Record<Kind, string> = {
  recognition: marked('Correct answers'),
  metric: marked('Bound on a metric'),
  lc_cusum: marked('Competence by LC-CUSUM'),
};

/** Requirements, all of which must be met at once. */
export function RequirementsEditor({
  requirements,
  onRequirements,
}: {
  readonly requirements: readonly RequirementDraft[];
  readonly onRequirements: (next: readonly RequirementDraft[]) => void;
}) {
  const change = (key: number, to: Partial<RequirementDraft>) =>
    onRequirements(requirements.map((one) => (one.key === key ? { ...one, ...to } : one)));
  return (
    <div className={styles.stack}>
      {requirements.map((one, place) => {
        const props = { draft: one, change: (to: Partial<RequirementDraft>) => change(one.key, to) };
        const wrong = requirementProblem(one);
        return (
          <fieldset key={one.key} className={styles.requirement}>
            <legend>
              {place + 1}. {say(kKinds[one.kind])}
            </legend>
            {one.kind === 'metric' ? <MetricFields {...props} /> : null}
            {one.kind === 'recognition' ? <RecognitionFields {...props} /> : null}
            {one.kind === 'lc_cusum' ? <RateFields {...props} /> : null}
            <div className={styles.under}>
              <span role="status" className={styles.muted}>
                {wrong}
              </span>
              <Button
                look="quiet"
                label={say('Remove requirement {number}', { number: place + 1 })}
                onClick={() => onRequirements(requirements.filter(({ key }) => key !== one.key))}
              >
                {say('Remove')}
              </Button>
            </div>
          </fieldset>
        );
      })}
      <div className={styles.buttons}>
        {(Object.keys(kKinds) as Kind[]).map((kind) => (
          <Button key={kind} onClick={() => onRequirements([...requirements, newRequirement(kind)])}>
            {say('Add: {kind}', { kind: say(kKinds[kind]) })}
          </Button>
        ))}
      </div>
    </div>
  );
}
