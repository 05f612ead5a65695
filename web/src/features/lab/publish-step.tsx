import { useMutation, useQueries, useQuery, useQueryClient } from '@tanstack/react-query';
import { useState, type FormEvent } from 'react';
import { Link } from 'wouter';
import {
  betterModelAddress,
  labRunQuery,
  labRunsQuery,
  modelAddress,
  publishRun,
  type LabRun,
  type LabRunSummary,
  type ModelVersion,
} from '@/api';
import { say, Sentence } from '@/language';
import { AskDialog, Badge, Button, Card, Field, Notice, Skeleton } from '@/ui';
import { formatClock, formatFigure } from '@/units';
import { addedEffects } from './add-step';
import { primaryUnit } from './comparison-parts';
import styles from './lab.module.css';
import { SendCard } from './send-card';
import { effectName, joined, workAddress } from './names';
import { isNotBetter } from './verdict';

interface Props {
  readonly model: ModelVersion;
  readonly set: string;
  readonly versions: readonly ModelVersion[];
}

/** Effects of a run and its held-out error. */
export function candidateText(run: LabRun): string {
  const error = run.fit?.held_out_rmse ?? run.diagnosis?.steps.at(-1)?.held_out_rmse;
  const what = run.diagnosis
    ? joined(run.diagnosis.effects.map(({ id }) => effectName(id))) || say('refitted')
    : addedEffects(run) || say('no effect added');
  return say('{effects}: {error} on held-out trials', { effects: what, error: formatFigure(error, primaryUnit(run)) });
}

function Candidate({
  run,
  summary,
  chosen,
  choose,
}: {
  readonly run: LabRun | undefined;
  readonly summary: LabRunSummary;
  readonly chosen: boolean;
  readonly choose: () => void;
}) {
  return (
    <label className={styles.choice}>
      <input type="radio" name="candidate" checked={chosen} onChange={choose} />
      <span className={styles.choiceText}>
        <span className={styles.choiceName}>
          {run ? candidateText(run) : <Skeleton width="60%" />}{' '}
          {summary.version === null ? null : <Badge tone="good">{say('published')}</Badge>}{' '}
          {run && isNotBetter(run) ? <Badge tone="warn">{say('not better than the old model')}</Badge> : null}
        </span>
        <span className={styles.muted}>
          {summary.kind === 'fit' ? say('fitted manually') : say('found by the search')}
        </span>
      </span>
      <span className={styles.muted}>{formatClock(summary.made_utc_us)}</span>
    </label>
  );
}

function Published({
  version,
  base,
  set,
}: {
  readonly version: string;
  readonly base: ModelVersion;
  readonly set: string;
}) {
  return (
    <Card title={say('Published')}>
      <div className={styles.stack} data-part="published">
        <p>
          <Sentence
            text="The version is in the list and cannot be changed. It is based on <strong>{model}</strong>."
            values={{ model: base.name }}
            parts={{ strong: (words) => <strong>{words}</strong> }}
          />
        </p>
        <p className={styles.buttons}>
          <Link href={`/lab/versions?a=${base.id}&b=${version}&set=${set}`} className={styles.solidLink}>
            {say('Compare old and new version')}
          </Link>
          <Link href={workAddress(version, set)}>{say('Continue with the new version')}</Link>
        </p>
        <p className={styles.muted}>
          <Sentence
            text="<link>Download the file</link> to use it with <code>tractus</code> or at a station."
            parts={{
              link: (words) => (
                <a href={modelAddress(version)} download={`${base.name}.model.json`}>
                  {words}
                </a>
              ),
              code: (words) => <code>{words}</code>,
            }}
          />
        </p>
      </div>
    </Card>
  );
}

/** Publishes the model of a run as a version. */
export function PublishStep({ model, set, versions }: Props) {
  const client = useQueryClient();
  const list = useQuery(labRunsQuery({ model: model.id, measurements: set }));
  const ready = (list.data?.runs ?? []).filter(({ model_ready }) => model_ready);
  const full = useQueries({ queries: ready.map(({ id }) => labRunQuery(id)) });
  const [picked, setPicked] = useState<string | null>(null);
  const [name, setName] = useState(model.name);
  const [note, setNote] = useState<string | null>(null);
  const [asking, setAsking] = useState(false);
  const summary = ready.find(({ id }) => id === picked) ?? ready[0];
  const run = full[ready.findIndex(({ id }) => id === summary?.id)]?.data;
  const made = useMutation({
    mutationFn: () => publishRun(summary?.id ?? '', name.trim(), note ?? (run ? candidateText(run) : '')),
    onSuccess: () => client.invalidateQueries({ queryKey: ['lab'] }),
  });
  if (list.isError)
    return (
      <Notice tone="bad" title={say('The candidates could not be loaded.')} onRetry={() => void list.refetch()}>
        {list.error.message}
      </Notice>
    );
  if (list.isPending) return <Skeleton height="240px" />;
  if (!summary)
    return (
      <Notice title={say('No better model yet.')}>
        <Sentence
          text="<missing>Find missing effects</missing> or <add>add effects manually</add>, then publish the result here."
          parts={{
            missing: (words) => <Link href={workAddress(model.id, set, 'missing')}>{words}</Link>,
            add: (words) => <Link href={workAddress(model.id, set, 'add')}>{words}</Link>,
          }}
        />
      </Notice>
    );
  const version = summary.version ?? (made.data && made.variables === undefined ? made.data.id : null);
  const submit = (event: FormEvent) => {
    event.preventDefault();
    if (run && isNotBetter(run)) setAsking(true);
    else if (!made.isPending) made.mutate();
  };
  return (
    <>
      <Card title={say('Publish a model version')}>
        <form className={styles.stack} onSubmit={submit}>
          <fieldset className={styles.choices}>
            <legend className="hidden-visually">{say('Candidate')}</legend>
            {ready.map((one, i) => (
              <Candidate
                key={one.id}
                summary={one}
                run={full[i]?.data}
                chosen={one.id === summary.id}
                choose={() => {
                  setPicked(one.id);
                  made.reset();
                }}
              />
            ))}
          </fieldset>
          {version === null ? (
            <>
              <div className={styles.names}>
                <Field
                  label={say('Name')}
                  value={name}
                  maxLength={200}
                  required
                  onChange={(event) => setName(event.target.value)}
                />
                <Field
                  label={say('Note')}
                  value={note ?? (run ? candidateText(run) : '')}
                  maxLength={500}
                  onChange={(event) => setNote(event.target.value)}
                />
              </div>
              {made.isError ? (
                <Notice tone="bad" title={say('The model was not published.')}>
                  {made.error.message}
                </Notice>
              ) : null}
              <div className={styles.go}>
                <a href={betterModelAddress(summary.id)} download={`${name}.model.json`}>
                  {say('Download without publishing')}
                </a>
                <Button look="solid" type="submit" disabled={made.isPending || name.trim() === ''}>
                  {made.isPending ? say('Publishing…') : say('Publish')}
                </Button>
              </div>
            </>
          ) : null}
        </form>
      </Card>
      {asking && run ? (
        <AskDialog
          title={say('Publish a model that is not better?')}
          action={say('Publish it anyway')}
          onClose={() => setAsking(false)}
          onAction={() => made.mutateAsync()}
        >
          <p>
            {say(
              'On trials that the fit did not see, its error is not smaller than that of the model it came from ({candidate}).',
              { candidate: candidateText(run) },
            )}
          </p>
        </AskDialog>
      ) : null}
      {version === null ? null : <Published version={version} base={model} set={set} />}
      {version === null ? null : (
        <SendCard
          version={{
            id: version,
            name: made.data?.name ?? versions.find(({ id }) => id === version)?.name ?? model.name,
            rig: model.rig,
          }}
        />
      )}
    </>
  );
}
