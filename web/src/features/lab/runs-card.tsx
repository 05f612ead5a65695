import { useQuery } from '@tanstack/react-query';
import { Link } from 'wouter';
import { labRunsQuery, measurementsQuery, modelsQuery, type LabRunSummary } from '@/api';
import { marked, say } from '@/language';
import { Badge, Card, DataTable, Notice, Progress, type Tone } from '@/ui';
import { formatDateTime, formatShare, isoDateTime } from '@/units';
import styles from './lab.module.css';
import { effectName, joined, kRunLabels, stepOfRun, workAddress } from './names';

const kState: Record<LabRunSummary['state'], { label: string; tone: Tone }> = {
  queued: { label: marked('queued'), tone: 'neutral' },
  running: { label: marked('running'), tone: 'accent' },
  done: { label: marked('done'), tone: 'good' },
  failed: { label: marked('failed'), tone: 'bad' },
  cancelled: { label: marked('cancelled'), tone: 'warn' },
};

const addedTo = (run: LabRunSummary) =>
  [...run.add, ...run.own.map((name) => (name.startsWith('expression:') ? name : `expression:${name}`))].map(
    effectName,
  );

/** The recent runs of the lab. */
export function RunsCard() {
  const runs = useQuery(labRunsQuery());
  const models = useQuery(modelsQuery).data?.models,
    sets = useQuery(measurementsQuery).data?.measurements;
  const modelName = (id: string) => models?.find((one) => one.id === id)?.name ?? '–',
    setName = (id: string) => sets?.find((one) => one.id === id)?.name ?? '–';
  return (
    <Card title={say('Recent runs')}>
      {runs.isError ? (
        <Notice tone="bad" title={say('The list could not be loaded.')} onRetry={() => void runs.refetch()}>
          {runs.error.message}
        </Notice>
      ) : null}
      {runs.isError && !runs.data ? null : (
        <DataTable<LabRunSummary>
          caption={say('Runs')}
          order={say('newest first')}
          rows={runs.data?.runs}
          keyOf={({ id }) => id}
          empty={say('No runs yet. Select measurements and a model above.')}
          pageSize={20}
          columns={[
            {
              name: marked('Run'),
              by: (run) => say(kRunLabels[run.kind]),
              cell: (run) => (
                <>
                  <Link href={workAddress(run.model, run.measurements, stepOfRun[run.kind])} className={styles.strong}>
                    {say(kRunLabels[run.kind])}
                  </Link>
                  {addedTo(run).length > 0 ? (
                    <span className={styles.muted}>{say('with {effects}', { effects: joined(addedTo(run)) })}</span>
                  ) : null}
                </>
              ),
            },
            { name: marked('Model'), by: (run) => modelName(run.model), cell: (run) => modelName(run.model) },
            {
              name: marked('Measurements'),
              by: (run) => setName(run.measurements),
              cell: (run) => setName(run.measurements),
            },
            {
              name: marked('State'),
              by: (run) => say(kState[run.state].label),
              cell: (run) =>
                run.state === 'running' ? (
                  <span className={styles.going}>
                    <Progress done={run.share} of={1} label={say('Progress')} />
                    <span>{formatShare(run.share)}</span>
                  </span>
                ) : (
                  <Badge tone={kState[run.state].tone}>{say(kState[run.state].label)}</Badge>
                ),
            },
            {
              name: marked('Started'),
              by: (run) => run.made_utc_us,
              cell: (run) => (
                <>
                  <time dateTime={isoDateTime(run.made_utc_us)}>{formatDateTime(run.made_utc_us)}</time>, {run.made_by}
                </>
              ),
            },
          ]}
        />
      )}
    </Card>
  );
}
