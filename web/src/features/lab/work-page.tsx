import { useQuery } from '@tanstack/react-query';
import { useEffect } from 'react';
import { Link, useLocation, useSearch } from 'wouter';
import { measurementsQuery, modelsQuery, type MeasurementSet, type ModelVersion } from '@/api';
import { say, Sentence } from '@/language';
import { Badge, Card, Notice, Skeleton, Steps, useTitle } from '@/ui';
import { AddStep } from './add-step';
import { CompareStep, type Drawable } from './compare-step';
import styles from './lab.module.css';
import { MissingStep } from './missing-step';
import { PublishStep } from './publish-step';
import { RunState } from './run-state';
import { useComparison } from './use-run';
import { ErrorRegionsStep } from './error-regions-step';
import { kSteps, setFacts, workAddress, type Step } from './names';

interface Work {
  readonly model: ModelVersion;
  readonly set: MeasurementSet;
  readonly versions: readonly ModelVersion[];
}

/** What is chosen within a step, kept in the address. */
function useChoice(key: string): [string | null, (value: string | null) => void] {
  const search = useSearch();
  const [at, go] = useLocation();
  const set = (value: string | null) => {
    const next = new URLSearchParams(search);
    if (value === null) next.delete(key);
    else next.set(key, value);
    go(next.size > 0 ? `${at}?${next}` : at, { replace: true });
  };
  return [new URLSearchParams(search).get(key), set];
}

/** Compare and Where: both look at one comparison. */
function Compared({ model, set, versions, step }: Work & { readonly step: 'compare' | 'where' }) {
  const [against, setAgainst] = useChoice('against');
  const [region, setRegion] = useChoice('region');
  const beside = versions.find(({ id }) => id === against);
  const { run, error, begin, retry } = useComparison(model.id, set.id, beside?.id ?? null);
  if (error)
    return (
      <Notice tone="bad" title={say('The comparison could not be made.')} onRetry={retry}>
        {error.message}
      </Notice>
    );
  if (!run)
    return (
      <>
        <Skeleton height="120px" />
        <Skeleton height="480px" />
      </>
    );
  if (!run.comparisons)
    return (
      <Card title={say('Comparing')}>
        <RunState run={run} what={say('The comparison')} again={begin} />
      </Card>
    );
  const drawable: Drawable = {
    run,
    ...run.comparisons,
    rig: model.rig,
    names: {
      before: beside ? say('{model} (first)', { model: model.name }) : say('model'),
      after:
        run.comparisons.after && beside
          ? beside.name === model.name
            ? say('{model} (second)', { model: beside.name })
            : beside.name
          : null,
    },
  };
  return step === 'compare' ? (
    <CompareStep
      drawable={drawable}
      versions={versions.filter(({ id, rig }) => id !== model.id && rig === model.rig)}
      against={beside?.id ?? null}
      setAgainst={setAgainst}
    />
  ) : (
    <ErrorRegionsStep
      drawable={drawable}
      region={region === null ? null : Number(region)}
      setRegion={(next) => setRegion(next === null ? null : String(next))}
    />
  );
}

function Content({ work, step }: { readonly work: Work; readonly step: Step }) {
  const requested = new URLSearchParams(useSearch()).getAll('add');
  const { model, set } = work;
  switch (step) {
    case 'compare':
    case 'where':
      return <Compared {...work} step={step} />;
    case 'missing':
      return <MissingStep model={model.id} set={set.id} rig={model.rig} />;
    case 'add':
      return <AddStep key={requested.join(' ')} model={model.id} set={set.id} rig={model.rig} requested={requested} />;
    case 'publish':
      return <PublishStep key={model.id} model={model} set={set.id} versions={work.versions} />;
  }
}

/** One model against one set of measurements: from the comparison to a better version. */
export function WorkPage({
  model: modelId,
  set: setId,
  step: stepName,
}: {
  readonly model: string;
  readonly set: string;
  readonly step: string;
}) {
  const models = useQuery(modelsQuery),
    sets = useQuery(measurementsQuery);
  const model = models.data?.models.find(({ id }) => id === modelId),
    set = sets.data?.measurements.find(({ id }) => id === setId);
  const step = kSteps.find(({ id }) => id === stepName)?.id ?? 'compare';
  const name = say(kSteps.find(({ id }) => id === step)?.name ?? '');
  useTitle(model ? `${name}: ${model.name}` : say('Model lab'));
  useEffect(() => {
    window.scrollTo({ top: 0 });
  }, [step]);
  const failed = models.error ?? sets.error;
  const back = (
    <p className={styles.back}>
      <Link href="/lab">{say('← Model lab')}</Link>
    </p>
  );
  if (failed)
    return (
      <div className={styles.page}>
        {back}
        <Notice
          tone="bad"
          title={say('The lab could not be loaded.')}
          onRetry={() => {
            void models.refetch();
            void sets.refetch();
          }}
        >
          {failed.message}
        </Notice>
      </div>
    );
  if (models.isPending || sets.isPending)
    return (
      <div className={styles.page}>
        {back}
        <Skeleton width="360px" height="36px" />
        <Skeleton height="54px" />
        <Skeleton height="480px" />
      </div>
    );
  if (!model || !set || !models.data)
    return (
      <div className={styles.page}>
        {back}
        <Notice tone="warn" title={model ? say('Measurements not found.') : say('Model not found.')}>
          {say('Check the address. The data may be on another server.')}
        </Notice>
      </div>
    );
  return (
    <div className={styles.page}>
      {back}
      <div>
        <h1>{model.name}</h1>
        <p className={styles.against}>
          <Sentence
            text="compared with <strong>{set}</strong>"
            values={{ set: set.name }}
            parts={{ strong: (words) => <strong>{words}</strong> }}
          />{' '}
          {set.simulated === true ? <Badge tone="warn">{say('simulated measurements')}</Badge> : null}{' '}
          <span className={styles.muted}>
            {setFacts(set)}
            {model.note === '' ? '' : ` · ${say('model: {note}', { note: model.note })}`}
          </span>
        </p>
      </div>
      <Steps
        label={say('Steps')}
        steps={kSteps.map(({ id, name: stepTitle }) => ({
          href: workAddress(model.id, set.id, id),
          name: say(stepTitle),
          current: id === step,
        }))}
      />
      <Content work={{ model, set, versions: models.data.models }} step={step} />
    </div>
  );
}
