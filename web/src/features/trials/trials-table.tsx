import type { ComponentProps } from 'react';
import { Link } from 'wouter';
import { personOf, type TrialSummary } from '@/api';
import { marked, say } from '@/language';
import { Badge, ListTable, type ListColumn, type ListFilter } from '@/ui';
import { formatDateTime, formatDuration, isoDateTime } from '@/units';
import styles from './trials-table.module.css';

function AnswerCell({ trial }: { readonly trial: TrialSummary }) {
  if (trial.correct === true) return <Badge tone="good">{say('✓ correct')}</Badge>;
  if (trial.correct === false) return <Badge tone="bad">{say('✗ incorrect')}</Badge>;
  return <span className={styles.none}>{trial.state === 'assessed' ? say('none') : '–'}</span>;
}

function StateCell({ trial }: { readonly trial: TrialSummary }) {
  switch (trial.state) {
    case 'assessing':
      return <Badge tone="accent">{say('assessing…')}</Badge>;
    case 'failed':
      return <Badge tone="bad">{say('failed')}</Badge>;
    case 'assessed':
      return <span className={styles.none}>{say('assessed')}</span>;
  }
}

const kColumns: readonly ListColumn<TrialSummary>[] = [
  {
    name: marked('Started'),
    sort: 'started',
    falls: true,
    cell: (trial) => <time dateTime={isoDateTime(trial.started_utc_us)}>{formatDateTime(trial.started_utc_us)}</time>,
  },
  {
    name: marked('Case'),
    sort: 'case',
    cell: (trial) => (
      <Link href={`/trials/${encodeURIComponent(trial.id)}`} className={styles.link}>
        {trial.case_title}
      </Link>
    ),
  },
  {
    name: marked('Person'),
    sort: 'person',
    cell: (trial) => (
      <span className={styles.operator}>
        {personOf(trial)}
        {trial.simulated ? <Badge tone="warn">{say('simulated')}</Badge> : null}
      </span>
    ),
  },
  { name: marked('Station'), sort: 'station', cell: (trial) => trial.station },
  { name: marked('Duration'), sort: 'duration', cell: (trial) => formatDuration(trial.duration_s), number: true },
  { name: marked('Answer'), cell: (trial) => <AnswerCell trial={trial} /> },
  { name: marked('State'), cell: (trial) => <StateCell trial={trial} /> },
];

const kFilters: readonly ListFilter[] = [
  {
    name: 'answer',
    label: marked('Answer'),
    choices: [
      { value: 'correct', text: marked('correct') },
      { value: 'incorrect', text: marked('incorrect') },
      { value: 'none', text: marked('no answer') },
    ],
  },
  {
    name: 'state',
    label: marked('State'),
    choices: [
      { value: 'assessing', text: marked('being assessed') },
      { value: 'failed', text: marked('failed') },
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
      caption={say('Trials')}
      className={styles.frame}
      rows={trials}
      keyOf={({ id }) => id}
      empty={say('No trials yet. A trial appears here after a station has uploaded it completely.')}
      waiting={8}
      columns={kColumns}
      usual="started"
      searchLabel={say('Find by person, case or station')}
      filters={kFilters}
      remark={remark}
    />
  );
}
