import { useMutation, useQuery, useQueryClient } from '@tanstack/react-query';
import { useState } from 'react';
import { Link, useLocation } from 'wouter';
import {
  addCurriculum,
  allCasesQuery,
  curriculaQuery,
  scenariosQuery,
  type Curriculum,
  type CurriculumVersion,
} from '@/api';
import { say } from '@/language';
import { Button, Card, Field, Notice, Skeleton, useTitle } from '@/ui';
import { formatCount } from '@/units';
import styles from './criteria.module.css';
import {
  curriculumRequest,
  draftOf,
  newStep,
  stepProblem,
  withoutStep,
  type CaseChoice,
  type StepDraft,
} from './draft';
import { useMetrics } from './parts';
import { RequirementsEditor } from './requirements-editor';

const changedAt = ({ versions }: Curriculum): number => versions.at(-1)?.made_utc_us ?? 0;

interface Choices {
  readonly choices: readonly CaseChoice[] | undefined;
  readonly failed: Error | null;
  readonly retry: () => void;
}

/** All cases and scenarios that a step can have, and those that its steps have already. */
function useChoices(there: readonly CaseChoice[]): Choices {
  const cases = useQuery(allCasesQuery),
    scenarios = useQuery(scenariosQuery);
  const failed = cases.error ?? scenarios.error;
  const retry = () => {
    void cases.refetch();
    void scenarios.refetch();
  };
  if (!cases.data || !scenarios.data) return { choices: undefined, failed, retry };
  const known: readonly CaseChoice[] = [
    ...cases.data.cases.filter(({ retired }) => !retired).map(({ id, title }) => ({ key: `case ${id}`, title })),
    ...scenarios.data.scenarios
      .filter(({ published }) => published)
      .map(({ id, name }) => ({ key: `case ${id}`, title: name })),
    ...scenarios.data.tuned.map(({ kind, name }) => ({
      key: `tuned ${kind}`,
      title: say('{name} (built-in)', { name }),
    })),
  ];
  const keys = new Set(known.map(({ key }) => key));
  return { choices: [...known, ...there.filter(({ key }) => !keys.has(key))], failed, retry };
}

function Step({
  step,
  place,
  before,
  choices,
  onStep,
  onRemove,
}: {
  readonly step: StepDraft;
  readonly place: number;
  readonly before: readonly StepDraft[];
  readonly choices: readonly CaseChoice[];
  readonly onStep: (change: Partial<StepDraft>) => void;
  readonly onRemove: () => void;
}) {
  const has = (key: string) => step.cases.some((one) => one.key === key);
  const wrong = stepProblem(step);
  return (
    <Card
      title={`${say('Step {number}', { number: formatCount(place + 1) })}${step.name.trim() === '' ? '' : `: ${step.name}`}`}
      aside={
        <Button look="quiet" label={say('Remove step {number}', { number: formatCount(place + 1) })} onClick={onRemove}>
          {say('Remove')}
        </Button>
      }
    >
      <div className={styles.stack}>
        <div className={styles.form}>
          <Field
            label={say('Name, shown to trainees')}
            value={step.name}
            maxLength={100}
            onChange={(event) => onStep({ name: event.target.value })}
          />
          <Field
            label={say('Planned trials of each case')}
            inputMode="numeric"
            value={step.repeats}
            onChange={(event) => onStep({ repeats: event.target.value })}
          />
        </div>
        <fieldset className={styles.choices}>
          <legend>{say('Cases')}</legend>
          {choices.map((one) => (
            <label key={one.key}>
              <input
                type="checkbox"
                checked={has(one.key)}
                onChange={() =>
                  onStep({
                    cases: has(one.key) ? step.cases.filter(({ key }) => key !== one.key) : [...step.cases, one],
                  })
                }
              />
              {one.title}
            </label>
          ))}
        </fieldset>
        {before.length === 0 ? null : (
          <fieldset className={styles.choices}>
            <legend>{say('Only after')}</legend>
            {before.map(({ id, name }, i) => (
              <label key={id}>
                <input
                  type="checkbox"
                  checked={step.after.includes(id)}
                  onChange={() =>
                    onStep({
                      after: step.after.includes(id) ? step.after.filter((one) => one !== id) : [...step.after, id],
                    })
                  }
                />
                {name.trim() === '' ? say('Step {number}', { number: formatCount(i + 1) }) : name}
              </label>
            ))}
          </fieldset>
        )}
        <h3>{say('Passed when')}</h3>
        <RequirementsEditor
          requirements={step.requirements}
          onRequirements={(requirements) => onStep({ requirements })}
        />
        <p role="status" className={styles.muted}>
          {wrong}
        </p>
      </div>
    </Card>
  );
}

function Editor({ id, of }: { readonly id: string | undefined; readonly of: CurriculumVersion | undefined }) {
  const client = useQueryClient();
  const [, go] = useLocation();
  const { unitOf } = useMetrics();
  const [title, setTitle] = useState(of?.title ?? '');
  const [reason, setReason] = useState('');
  const [steps, setSteps] = useState<readonly StepDraft[]>(
    () =>
      of?.steps.map((step) => ({
        id: step.id,
        name: step.name,
        cases: step.cases.map((one) => ({ key: `case ${one.id}`, title: one.title })),
        repeats: String(step.repeats),
        after: step.after,
        requirements: step.requirements.map((one) => draftOf(one, unitOf)),
      })) ?? [newStep([])],
  );
  const { choices, failed, retry } = useChoices(steps.flatMap(({ cases }) => cases));
  const made = useMutation({
    mutationFn: () => addCurriculum(curriculumRequest(id, title, reason, steps, unitOf)),
    onSuccess: (list) => {
      client.setQueryData(curriculaQuery.queryKey, list);
      const newest = [...list.curricula].sort((a, b) => changedAt(b) - changedAt(a))[0]?.id ?? '';
      go(`/curricula/${id ?? newest}`);
    },
  });
  const wrong = title.trim() === '' ? say('Enter a title.') : (steps.map(stepProblem).find((one) => one !== '') ?? '');
  const change = (step: StepDraft, to: Partial<StepDraft>) =>
    setSteps(steps.map((one) => (one.id === step.id ? { ...one, ...to } : one)));
  return (
    <>
      <Card title={say('Curriculum')}>
        <div className={styles.form}>
          <Field
            label={say('Title')}
            value={title}
            maxLength={150}
            required
            placeholder={say('Pedicle screws, year 1')}
            onChange={(event) => setTitle(event.target.value)}
          />
          {id === undefined ? null : (
            <Field
              label={say('Reason of the change (optional)')}
              value={reason}
              maxLength={400}
              onChange={(event) => setReason(event.target.value)}
            />
          )}
        </div>
      </Card>
      {failed ? (
        <Notice tone="bad" title={say('The cases could not be loaded.')} onRetry={retry}>
          {failed.message}
        </Notice>
      ) : choices === undefined ? (
        <Skeleton height="320px" />
      ) : (
        steps.map((step, place) => (
          <Step
            key={step.id}
            step={step}
            place={place}
            before={steps.slice(0, place)}
            choices={choices}
            onStep={(to) => change(step, to)}
            onRemove={() => setSteps(withoutStep(steps, step.id))}
          />
        ))
      )}
      <div className={styles.buttons}>
        <Button onClick={() => setSteps([...steps, newStep(steps)])}>{say('Add a step')}</Button>
      </div>
      {made.isError ? (
        <Notice tone="bad" title={say('The curriculum was not stored.')}>
          {made.error.message}
        </Notice>
      ) : null}
      <div className={styles.go}>
        <span>{wrong}</span>
        <Button
          look="solid"
          disabled={wrong !== '' || steps.length === 0 || made.isPending}
          onClick={() => made.mutate()}
        >
          {id === undefined ? say('Make the curriculum') : say('Store as a new version')}
        </Button>
      </div>
    </>
  );
}

/** Writes a curriculum, or a new version of one. */
export function CurriculumEditor({ id }: { readonly id?: string }) {
  const query = useQuery({ ...curriculaQuery, enabled: id !== undefined });
  const { metrics } = useMetrics();
  const of = query.data?.curricula.find((one) => one.id === id)?.versions.at(-1);
  const heading = id === undefined ? say('New curriculum') : say('Change the curriculum');
  useTitle(heading);
  const waits = (id !== undefined && query.data === undefined) || metrics.length === 0;
  return (
    <div className={styles.page}>
      <p>
        <Link href={id === undefined ? '/curricula' : `/curricula/${id}`}>← {say('Curricula')}</Link>
      </p>
      <div>
        <h1>{heading}</h1>
        {id === undefined ? null : (
          <p className={styles.lead}>
            {say('This makes a new version for trainees who begin later. A trainee who has begun keeps their version.')}
          </p>
        )}
      </div>
      {query.isError ? (
        <Notice tone="bad" title={say('The curriculum could not be loaded.')} onRetry={() => void query.refetch()}>
          {query.error.message}
        </Notice>
      ) : waits ? (
        <Skeleton height="320px" />
      ) : (
        <Editor id={id} of={of} />
      )}
    </div>
  );
}
