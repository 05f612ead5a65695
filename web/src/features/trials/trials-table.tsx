import { Link } from 'wouter';
import type { TrialSummary } from '@/api';
import { Badge, DataTable, type DataColumn } from '@/ui';
import { formatDateTime, formatDuration, isoDateTime } from '@/units';
import styles from './trials-table.module.css';

function AnswerCell({ trial }: { readonly trial: TrialSummary }) {
  if (trial.correct === true) return <Badge tone="good">✓ correct</Badge>;
  if (trial.correct === false) return <Badge tone="bad">✗ incorrect</Badge>;
  return <span className={styles.none}>{trial.state === 'assessed' ? 'none' : '–'}</span>;
}

function StateCell({ trial }: { readonly trial: TrialSummary }) {
  switch (trial.state) {
    case 'assessing':
      return <Badge tone="accent">assessing…</Badge>;
    case 'failed':
      return <Badge tone="bad">failed</Badge>;
    case 'assessed':
      return <span className={styles.none}>assessed</span>;
  }
}

const kColumns: readonly DataColumn<TrialSummary>[] = [
  {
    name: 'Started',
    by: (trial) => trial.started_utc_us,
    cell: (trial) => <time dateTime={isoDateTime(trial.started_utc_us)}>{formatDateTime(trial.started_utc_us)}</time>,
  },
  {
    name: 'Case',
    by: (trial) => trial.case_title,
    cell: (trial) => (
      <Link href={`/trials/${encodeURIComponent(trial.id)}`} className={styles.link}>
        {trial.case_title}
      </Link>
    ),
  },
  {
    name: 'Operator',
    by: (trial) => trial.operator_name,
    cell: (trial) => (
      <span className={styles.operator}>
        {trial.operator_name}
        {trial.simulated ? <Badge tone="warn">simulated</Badge> : null}
      </span>
    ),
  },
  { name: 'Station', by: (trial) => trial.station, cell: (trial) => trial.station },
  {
    name: 'Duration',
    by: (trial) => trial.duration_s,
    cell: (trial) => formatDuration(trial.duration_s),
    number: true,
  },
  { name: 'Answer', by: (trial) => trial.correct, cell: (trial) => <AnswerCell trial={trial} /> },
  { name: 'State', by: (trial) => trial.state, cell: (trial) => <StateCell trial={trial} /> },
];

interface Props {
  /** `undefined` while loading: rows of the same height hold the place. */
  readonly trials: readonly TrialSummary[] | undefined;
  /** The server has older ones. */
  readonly partial?: boolean;
}

export function TrialsTable({ trials, partial = false }: Props) {
  return (
    <DataTable
      caption="Trials"
      order="newest first"
      className={styles.frame}
      rows={trials}
      keyOf={({ id }) => id}
      empty="No trials yet."
      waiting={8}
      partial={partial}
      filter={{
        label: 'Filter by case, operator or station',
        text: (trial) => `${trial.case_title} ${trial.operator_name} ${trial.station}`,
      }}
      columns={kColumns}
    />
  );
}
