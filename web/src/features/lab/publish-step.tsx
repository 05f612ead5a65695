import { useMutation, useQueries, useQuery, useQueryClient } from '@tanstack/react-query';
import { useState, type FormEvent } from 'react';
import { Link } from 'wouter';
import { betterModelAddress, labRunQuery, labRunsQuery, modelAddress, publishRun, type LabRun, type LabRunSummary, type ModelVersion } from '@/api';
import { Badge, Button, Card, Field, Notice, Skeleton } from '@/ui';
import { formatClock, formatFigure } from '@/units';
import { addedWords } from './add-step';
import { primaryOf } from './comparison-parts';
import styles from './lab.module.css';
import { SendCard } from './send-card';
import { channelUnit, effectName, joined, workAddress } from './words';

interface Props { readonly model: ModelVersion; readonly set: string; readonly versions: readonly ModelVersion[] }

/** What a run made: its effects and what they leave. */
export function madeWords(run: LabRun): string {
  const primary = run.comparisons ? primaryOf(run.comparisons.before)?.name ?? 'force_N' : 'force_N';
  const error = run.fit?.held_out_rmse ?? run.diagnosis?.steps.at(-1)?.held_out_rmse;
  const what = run.diagnosis ? joined(run.diagnosis.effects.map(({ id }) => effectName(id))) || 'refitted' : addedWords(run);
  return `${what}: ${formatFigure(error, channelUnit(primary))} on held-out trials`;
}

function Candidate({ run, summary, chosen, choose }: { readonly run: LabRun | undefined; readonly summary: LabRunSummary; readonly chosen: boolean; readonly choose: () => void }) {
  return (
    <label className={styles.choice}>
      <input type="radio" name="candidate" checked={chosen} onChange={choose} />
      <span className={styles.choiceText}>
        <span className={styles.choiceName}>{run ? madeWords(run) : <Skeleton width="60%" />} {summary.version === null ? null : <Badge tone="good">published</Badge>}</span>
        <span className={styles.muted}>{summary.kind === 'fit' ? 'fitted by hand' : 'found by the search'}</span>
      </span>
      <span className={styles.muted}>{formatClock(summary.made_utc_us)}</span>
    </label>
  );
}

function Published({ version, base, set }: { readonly version: string; readonly base: ModelVersion; readonly set: string }) {
  return (
    <Card title="Published">
      <div className={styles.stack} data-part="published">
        <p>The version is in the list and never changes. It came from <strong>{base.name}</strong>.</p>
        <p className={styles.buttons}>
          <Link href={`/lab/versions?a=${base.id}&b=${version}&set=${set}`} className={styles.solidLink}>Old and new side by side</Link>
          <Link href={workAddress(version, set)}>Go on from the new version</Link>
        </p>
        <p className={styles.muted}><a href={modelAddress(version)} download={`${base.name}.model.json`}>Save the file</a>: it drives <code>tractus</code> and a station as it is.</p>
      </div>
    </Card>
  );
}

/** The better model as a version that others can use. */
export function PublishStep({ model, set, versions }: Props) {
  const client = useQueryClient();
  const list = useQuery(labRunsQuery({ model: model.id, measurements: set }));
  const ready = (list.data?.runs ?? []).filter(({ model_ready }) => model_ready);
  const full = useQueries({ queries: ready.map(({ id }) => labRunQuery(id)) });
  const [picked, setPicked] = useState<string | null>(null);
  const [name, setName] = useState(model.name);
  const [note, setNote] = useState<string | null>(null);
  const summary = ready.find(({ id }) => id === picked) ?? ready[0];
  const run = full[ready.findIndex(({ id }) => id === summary?.id)]?.data;
  const made = useMutation({
    mutationFn: () => publishRun(summary?.id ?? '', name.trim(), note ?? (run ? madeWords(run) : '')),
    onSuccess: () => client.invalidateQueries({ queryKey: ['lab'] }),
  });
  if (list.isError) return <Notice tone="bad" title="The candidates could not be loaded." onRetry={() => void list.refetch()}>{list.error.message}</Notice>;
  if (list.isPending) return <Skeleton height="240px" />;
  if (!summary) return <Notice title="There is no better model yet.">Let <Link href={workAddress(model.id, set, 'missing')}>what is missing</Link> be found, or <Link href={workAddress(model.id, set, 'add')}>add an effect by hand</Link>; what comes of it can be published here.</Notice>;
  const version = summary.version ?? (made.data && made.variables === undefined ? made.data.id : null);
  const submit = (event: FormEvent) => { event.preventDefault(); if (!made.isPending) made.mutate(); };
  return (
    <>
      <Card title="Publish a better model">
        <form className={styles.stack} onSubmit={submit}>
          <fieldset className={styles.choices}><legend className="hidden-visually">Which one</legend>{ready.map((one, i) => <Candidate key={one.id} summary={one} run={full[i]?.data} chosen={one.id === summary.id} choose={() => { setPicked(one.id); made.reset(); }} />)}</fieldset>
          {version === null ? (
            <>
              <div className={styles.names}>
                <Field label="Name" value={name} maxLength={200} required onChange={(event) => setName(event.target.value)} />
                <Field label="Note" value={note ?? (run ? madeWords(run) : '')} maxLength={500} onChange={(event) => setNote(event.target.value)} />
              </div>
              {made.isError ? <Notice tone="bad" title="It was not published.">{made.error.message}</Notice> : null}
              <div className={styles.go}>
                <a href={betterModelAddress(summary.id)} download={`${name}.model.json`}>Save the file without publishing</a>
                <Button look="solid" type="submit" disabled={made.isPending || name.trim() === ''}>{made.isPending ? 'Publishing…' : 'Publish'}</Button>
              </div>
            </>
          ) : null}
        </form>
      </Card>
      {version === null ? null : <Published version={version} base={model} set={set} />}
      {version === null ? null : <SendCard version={{ id: version, name: made.data?.name ?? versions.find(({ id }) => id === version)?.name ?? model.name, rig: model.rig }} />}
    </>
  );
}
