import { useQuery } from '@tanstack/react-query';
import { Link } from 'wouter';
import { labRunsQuery, measurementsQuery, modelsQuery, type LabRunSummary } from '@/api';
import { Badge, Card, Notice, Progress, Scroll, Skeleton, type Tone } from '@/ui';
import { formatDateTime, formatShare, isoDateTime } from '@/units';
import styles from './lab.module.css';
import { effectName, joined, kRunLabels, stepOfRun, workAddress } from './names';

const kState: Record<LabRunSummary['state'], { label: string; tone: Tone }> = {
  queued: { label: 'queued', tone: 'neutral' },
  running: { label: 'running', tone: 'accent' },
  done: { label: 'done', tone: 'good' },
  failed: { label: 'failed', tone: 'bad' },
  cancelled: { label: 'cancelled', tone: 'warn' },
};

function Row({ run, model, set }: { readonly run: LabRunSummary; readonly model: string; readonly set: string }) {
  const { label, tone } = kState[run.state];
  const added = [
    ...run.add,
    ...run.own.map((name) => (name.startsWith('expression:') ? name : `expression:${name}`)),
  ].map(effectName);
  return (
    <tr>
      <td>
        <Link href={workAddress(run.model, run.measurements, stepOfRun[run.kind])} className={styles.strong}>
          {kRunLabels[run.kind]}
        </Link>
        {added.length > 0 ? <span className={styles.muted}> with {joined(added)}</span> : null}
      </td>
      <td>{model}</td>
      <td>{set}</td>
      <td>
        {run.state === 'running' ? (
          <span className={styles.going}>
            <Progress done={run.share} of={1} label="Progress" />
            <span>{formatShare(run.share)}</span>
          </span>
        ) : (
          <Badge tone={tone}>{label}</Badge>
        )}
      </td>
      <td>
        <time dateTime={isoDateTime(run.made_utc_us)}>{formatDateTime(run.made_utc_us)}</time>, {run.made_by}
      </td>
    </tr>
  );
}

/** The recent runs of the lab. */
export function RunsCard() {
  const runs = useQuery(labRunsQuery());
  const models = useQuery(modelsQuery).data?.models,
    sets = useQuery(measurementsQuery).data?.measurements;
  const modelName = (id: string) => models?.find((one) => one.id === id)?.name ?? '–',
    setName = (id: string) => sets?.find((one) => one.id === id)?.name ?? '–';
  return (
    <Card title="Recent runs">
      {runs.isError ? (
        <Notice tone="bad" title="The list could not be loaded." onRetry={() => void runs.refetch()}>
          {runs.error.message}
        </Notice>
      ) : null}
      {runs.isPending ? <Skeleton height="120px" /> : null}
      {runs.data?.runs.length === 0 ? (
        <p className={styles.muted}>No runs yet. Select measurements and a model above.</p>
      ) : null}
      {runs.data && runs.data.runs.length > 0 ? (
        <Scroll label="Runs, newest first">
          <table className={styles.table}>
            <caption className="hidden-visually">Runs, newest first</caption>
            <thead>
              <tr>
                <th scope="col">Run</th>
                <th scope="col">Model</th>
                <th scope="col">Measurements</th>
                <th scope="col">State</th>
                <th scope="col">Started</th>
              </tr>
            </thead>
            <tbody>
              {runs.data.runs.slice(0, 20).map((run) => (
                <Row key={run.id} run={run} model={modelName(run.model)} set={setName(run.measurements)} />
              ))}
            </tbody>
          </table>
        </Scroll>
      ) : null}
    </Card>
  );
}
