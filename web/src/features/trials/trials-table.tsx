import { Link } from 'wouter';
import { personOf, type TrialSummary } from '@/api';
import { Badge, SortHead, Table, type Column, type DataColumn } from '@/ui';
import { formatDateTime, formatDuration, isoDateTime } from '@/units';
import type { TrialView } from './search';
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

type Sort = TrialView['sort'];

const kColumns: readonly (DataColumn<TrialSummary> & { readonly sort?: Sort })[] = [
  {
    name: 'Started',
    sort: 'started',
    cell: (trial) => <time dateTime={isoDateTime(trial.started_utc_us)}>{formatDateTime(trial.started_utc_us)}</time>,
  },
  {
    name: 'Case',
    sort: 'case',
    cell: (trial) => (
      <Link href={`/trials/${encodeURIComponent(trial.id)}`} className={styles.link}>
        {trial.case_title}
      </Link>
    ),
  },
  {
    name: 'Person',
    sort: 'person',
    cell: (trial) => (
      <span className={styles.operator}>
        {personOf(trial)}
        {trial.simulated ? <Badge tone="warn">simulated</Badge> : null}
      </span>
    ),
  },
  { name: 'Station', sort: 'station', cell: (trial) => trial.station },
  { name: 'Duration', sort: 'duration', cell: (trial) => formatDuration(trial.duration_s), number: true },
  { name: 'Answer', cell: (trial) => <AnswerCell trial={trial} /> },
  { name: 'State', cell: (trial) => <StateCell trial={trial} /> },
];

interface Props {
  /** `undefined` while loading: rows of the same height hold the place. */
  readonly trials: readonly TrialSummary[] | undefined;
  readonly view: Pick<TrialView, 'sort' | 'order'>;
  readonly onSort: (sort: Sort, order: TrialView['order']) => void;
}

/** The page of trials that the server sorted. */
export function TrialsTable({ trials, view, onSort }: Props) {
  const columns = kColumns.map((column): Column<TrialSummary> => {
    const { sort } = column;
    if (sort === undefined) return column;
    const sorted = view.sort === sort ? view.order : undefined;
    const press = () => onSort(sort, sorted === 'ascending' ? 'descending' : 'ascending');
    return { ...column, sorted, name: <SortHead column={column} sorted={sorted} onPress={press} /> };
  });
  return (
    <Table
      caption="Trials"
      className={styles.frame}
      rows={trials}
      keyOf={({ id }) => id}
      empty="No trials match."
      waiting={8}
      columns={columns}
    />
  );
}
