import type { ComponentProps } from 'react';
import { Link } from 'wouter';
import { personOf, type TrialSummary } from '@/api';
import { Badge, ListTable, type ListColumn, type ListFilter } from '@/ui';
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

const kColumns: readonly ListColumn<TrialSummary>[] = [
  {
    name: 'Started',
    sort: 'started',
    falls: true,
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

const kFilters: readonly ListFilter[] = [
  {
    name: 'answer',
    label: 'Answer',
    choices: [
      { value: 'correct', text: 'correct' },
      { value: 'incorrect', text: 'incorrect' },
      { value: 'none', text: 'no answer' },
    ],
  },
  {
    name: 'state',
    label: 'State',
    choices: [
      { value: 'assessing', text: 'being assessed' },
      { value: 'failed', text: 'failed' },
    ],
  },
];

type Props = Pick<ComponentProps<typeof ListTable<TrialSummary>>, 'list' | 'page' | 'views'> & {
  /** `undefined` while loading: rows of the same height hold the place. */
  readonly trials: readonly TrialSummary[] | undefined;
  readonly remark?: string;
};

/** A page of trials that the server found. */
export function TrialsTable({ trials, remark = '', ...rest }: Props) {
  return (
    <ListTable<TrialSummary>
      {...rest}
      caption="Trials"
      className={styles.frame}
      rows={trials}
      keyOf={({ id }) => id}
      empty="No trials yet. A trial appears here after a station has uploaded it completely."
      waiting={8}
      columns={kColumns}
      usual="started"
      searchLabel="Find by person, case or station"
      filters={kFilters}
      remark={remark}
    />
  );
}
