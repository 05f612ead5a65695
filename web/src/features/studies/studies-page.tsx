import { useQuery } from '@tanstack/react-query';
import { Link } from 'wouter';
import { studiesQuery, type StudySummary } from '@/api';
import { Badge, DataTable, Notice, Progress, useTitle, type DataColumn } from '@/ui';
import { formatCount, formatDateTime, isoDateTime } from '@/units';
import styles from './studies-page.module.css';

type State = 'complete' | 'paused' | 'running';
const kTones = { complete: 'good', paused: 'warn', running: 'accent' } as const;

const stateOf = (study: StudySummary): State =>
  study.planned > 0 && study.done === study.planned ? 'complete' : study.state === 'paused' ? 'paused' : 'running';

const kColumns: readonly DataColumn<StudySummary>[] = [
  {
    name: 'Study',
    by: (study) => study.title,
    cell: (study) => (
      <>
        <Link href={`/studies/${encodeURIComponent(study.id)}`} className={styles.link}>
          {study.title}
        </Link>{' '}
        <span className={styles.id}>{study.id}</span>
      </>
    ),
  },
  { name: 'State', by: stateOf, cell: (study) => <Badge tone={kTones[stateOf(study)]}>{stateOf(study)}</Badge> },
  {
    name: 'Participants',
    by: (study) => study.participants,
    cell: (study) => formatCount(study.participants),
    number: true,
  },
  {
    name: 'Trials done',
    by: (study) => study.done,
    cell: (study) => (
      <span className={styles.progress}>
        <Progress
          done={study.done}
          of={study.planned}
          label={`${formatCount(study.done)} of ${formatCount(study.planned)} trials done`}
        />
        <span>
          {formatCount(study.done)} of {formatCount(study.planned)}
        </span>
      </span>
    ),
  },
  {
    name: 'Created',
    by: (study) => study.made_utc_us,
    cell: (study) => (
      <>
        <time dateTime={isoDateTime(study.made_utc_us)}>{formatDateTime(study.made_utc_us)}</time>, {study.made_by}
      </>
    ),
  },
];

export function StudiesPage() {
  useTitle('Studies');
  const query = useQuery(studiesQuery);
  return (
    <>
      <div className={styles.head}>
        <h1>Studies</h1>
        <Link href="/studies/new" className={styles.make}>
          New study
        </Link>
      </div>
      {query.isError ? (
        <div className={styles.error}>
          <Notice
            tone="bad"
            title={query.data ? 'The list could not be refreshed.' : 'The studies could not be loaded.'}
            onRetry={() => void query.refetch()}
          >
            {query.error.message}
          </Notice>
        </div>
      ) : null}
      {query.data?.studies.length === 0 ? (
        <Notice title="No studies yet.">
          In a study, all participants do the same scenarios, blinded, each in an individual order. Create the first
          one.
        </Notice>
      ) : query.data || query.isPending ? (
        <DataTable
          caption="Studies"
          order="newest first"
          className={styles.frame}
          rows={query.data?.studies}
          keyOf={({ id }) => id}
          empty="No studies yet."
          filter={{ label: 'Filter by title or short name', text: (study) => `${study.title} ${study.id}` }}
          columns={kColumns}
        />
      ) : null}
    </>
  );
}
