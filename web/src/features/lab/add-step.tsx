import { useMutation, useQuery, useQueryClient } from '@tanstack/react-query';
import { useState } from 'react';
import { Link } from 'wouter';
import {
  effectsQuery,
  labRunQuery,
  labRunsQuery,
  startFit,
  type Effect,
  type EffectList,
  type Fit,
  type LabRun,
  type LabRunSummary,
  type OwnEffect,
  type Rig,
} from '@/api';
import { say } from '@/language';
import { Badge, Button, Card, Notice, Select, Skeleton, Term } from '@/ui';
import { formatClock, formatFigure } from '@/units';
import { Headline, primaryUnit } from './comparison-parts';
import { Series, type Drawable } from './compare-step';
import { ErrorSteps } from './error-steps';
import styles from './lab.module.css';
import { OwnFormula } from './own-formula';
import { Parameters } from './parameters';
import { RunState } from './run-state';
import { effectName, joined, kEffectKinds, workAddress } from './names';

interface Props {
  readonly model: string;
  readonly set: string;
  readonly rig: Rig;
  readonly requested: readonly string[];
}

/** Names of the effects that a fit adds; empty: none. */
export const addedEffects = (run: Pick<LabRunSummary, 'add' | 'own'>) =>
  joined(
    [...run.add, ...run.own.map((name) => (name.startsWith('expression:') ? name : `expression:${name}`))].map(
      effectName,
    ),
  );

/** What a fit is called beside the model that it came from. */
const fittedName = (run: Pick<LabRunSummary, 'add' | 'own'>) => {
  const effects = addedEffects(run);
  return effects === '' ? say('fitted') : say('with {effects}', { effects });
};

function Choice({
  effect,
  on,
  toggle,
}: {
  readonly effect: Effect;
  readonly on: boolean;
  readonly toggle: () => void;
}) {
  const kind = kEffectKinds[effect.kind];
  return (
    <label className={styles.effect}>
      <input type="checkbox" checked={on} onChange={toggle} />
      <span className={styles.choiceName}>
        {effectName(effect.id)}{' '}
        <Badge tone={effect.kind === 'measurement' ? 'warn' : 'neutral'}>{say(kind.label)}</Badge>
      </span>
      <code>{effect.equation}</code>
      <span className={styles.muted}>{effect.summary}</span>
    </label>
  );
}

function Chooser({
  model,
  set,
  rig,
  requested,
  list,
  onRun,
}: Props & { readonly list: EffectList; readonly onRun: (run: LabRun) => void }) {
  const client = useQueryClient();
  const [chosen, setChosen] = useState<readonly string[]>(requested);
  const [own, setOwn] = useState<OwnEffect | null>(null);
  const [withOwn, setWithOwn] = useState(false);
  const started = useMutation({
    mutationFn: () => startFit(model, set, chosen, withOwn && own ? [own] : []),
    onSuccess: async (run) => {
      client.setQueryData(labRunQuery(run.id).queryKey, run);
      await client.invalidateQueries({ queryKey: ['lab', 'runs'] });
      onRun(run);
    },
  });
  const toggle = (id: string) =>
    setChosen((before) => (before.includes(id) ? before.filter((one) => one !== id) : [...before, id]));
  const ready = withOwn ? own !== null : true;
  const what = joined([...chosen.map(effectName), ...(withOwn ? [say('the custom formula')] : [])]);
  return (
    <Card title={say('Add effects manually')}>
      <div className={styles.stack}>
        <fieldset className={styles.effects}>
          <legend className="hidden-visually">{say('Effects of the catalogue')}</legend>
          {list.effects.map((effect) => (
            <Choice key={effect.id} effect={effect} on={chosen.includes(effect.id)} toggle={() => toggle(effect.id)} />
          ))}
        </fieldset>
        <label className={styles.check}>
          <input type="checkbox" checked={withOwn} onChange={(event) => setWithOwn(event.target.checked)} />{' '}
          {say('Custom formula')}
        </label>
        {withOwn ? <OwnFormula rig={rig} list={list} onOwn={setOwn} /> : null}
        {started.isError ? (
          <Notice tone="bad" title={say('The fit was not started.')}>
            {started.error.message}
          </Notice>
        ) : null}
        <div className={styles.go}>
          <p className={styles.muted}>
            {what === ''
              ? say('No effect is selected: only the parameters of the model are fitted.')
              : say('Fit with {effects}.', { effects: what })}
          </p>
          <Button look="solid" disabled={!ready || started.isPending} onClick={() => started.mutate()}>
            {started.isPending ? say('Starting…') : what === '' ? say('Fit') : say('Add and fit')}
          </Button>
        </div>
      </div>
    </Card>
  );
}

function Fitted({
  run,
  fit,
  model,
  set,
  rig,
}: {
  readonly run: LabRun;
  readonly fit: Fit;
  readonly model: string;
  readonly set: string;
  readonly rig: Rig;
}) {
  const unit = primaryUnit(run),
    what = addedEffects(run);
  const name = fittedName(run);
  const drawable: Drawable | null = run.comparisons
    ? {
        run,
        ...run.comparisons,
        rig,
        names: { before: say('as supplied'), after: run.comparisons.after ? name : null },
      }
    : null;
  const better = fit.held_out_rmse !== null && fit.base.rmse !== null && fit.held_out_rmse < fit.base.rmse;
  return (
    <>
      <Card
        title={say('Error, {model}', { model: name })}
        aside={
          run.model_ready ? (
            <Link href={workAddress(model, set, 'publish')} className={styles.solidLink}>
              {say('Publish this model')}
            </Link>
          ) : null
        }
      >
        <div className={styles.stack}>
          <p role="status">
            {better
              ? say('Error on held-out trials: {error}. Model as supplied: {before}. Noise floor: {floor}.', {
                  error: formatFigure(fit.held_out_rmse, unit),
                  before: formatFigure(fit.base.rmse, unit),
                  floor: formatFigure(fit.noise_floor, unit),
                })
              : say(
                  'The fit does not improve the model. Error on held-out trials: {error}. Model as supplied: {before}.',
                  { error: formatFigure(fit.held_out_rmse, unit), before: formatFigure(fit.base.rmse, unit) },
                )}
            {fit.converged ? '' : ` ${say('The fit did not converge.')}`}
          </p>
          <ErrorSteps
            unit={unit}
            noise_floor={fit.noise_floor}
            steps={[
              { name: say('As supplied'), rmse: fit.base.rmse, held_out_rmse: fit.base.rmse },
              {
                name: what === '' ? say('Fitted') : `+ ${what}`,
                rmse: fit.rmse,
                held_out_rmse: fit.held_out_rmse,
              },
            ]}
          />
          {fit.remarks.map((remark) => (
            <p key={remark} className={styles.muted}>
              {remark}
            </p>
          ))}
        </div>
      </Card>
      {drawable ? (
        <Card title={say('Comparison with the supplied model')}>
          <div className={styles.stack}>
            <Headline before={drawable.before} after={drawable.after} names={drawable.names} />
            <Series drawable={drawable} />
          </div>
        </Card>
      ) : null}
      <Card title={say('Fitted parameters')}>
        <Parameters estimates={fit.parameters} />
        {fit.correlations.length > 0 ? (
          <p className={styles.muted}>
            <Term
              definition={say(
                'Two fitted parameters whose errors are correlated: the measurements determine their combination better than either of them.',
              )}
            >
              {say('Correlated parameters')}
            </Term>
            :{' '}
            {fit.correlations
              .map(({ between, correlation }) => `${joined(between)} (${formatFigure(correlation, '', 2)})`)
              .join('; ')}
            .
          </p>
        ) : null}
      </Card>
    </>
  );
}

/** Adds chosen effects or a custom formula, fits the model and shows the error. */
export function AddStep(props: Props) {
  const { model, set, rig } = props;
  const list = useQuery(effectsQuery(rig));
  const runs = useQuery(labRunsQuery({ kind: 'fit', model, measurements: set }));
  const [picked, setPicked] = useState<string | null>(null);
  const fits = runs.data?.runs ?? [];
  const shown = fits.find(({ id }) => id === picked) ?? fits[0];
  const one = useQuery({ ...labRunQuery(shown?.id ?? ''), enabled: shown !== undefined });
  const run = one.data;
  const error = list.error ?? runs.error ?? one.error;
  return (
    <>
      {error ? (
        <Notice
          tone="bad"
          title={say('Part of this page could not be loaded.')}
          onRetry={() => {
            void list.refetch();
            void runs.refetch();
            if (shown) void one.refetch();
          }}
        >
          {error.message}
        </Notice>
      ) : null}
      {list.data ? (
        <Chooser {...props} list={list.data} onRun={({ id }) => setPicked(id)} />
      ) : list.isPending ? (
        <Skeleton height="320px" />
      ) : null}
      {fits.length > 1 ? (
        <div className={styles.pick}>
          <Select
            label={say('Fit')}
            value={shown?.id ?? ''}
            onChange={(event) => setPicked(event.target.value)}
            options={fits.map((fit) => ({
              value: fit.id,
              text: `${addedEffects(fit) || say('no effect added')}, ${formatClock(fit.made_utc_us)}`,
            }))}
          />
        </div>
      ) : null}
      {run?.fit ? (
        <Fitted run={run} fit={run.fit} model={model} set={set} rig={rig} />
      ) : run ? (
        <Card title={say('Error, {model}', { model: fittedName(run) })}>
          <RunState
            run={run}
            what={say('The fit')}
            again={() => {
              setPicked(null);
            }}
          />
        </Card>
      ) : null}
    </>
  );
}
