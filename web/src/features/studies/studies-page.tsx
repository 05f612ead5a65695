import { useQuery } from '@tanstack/react-query';
import { Link } from 'wouter';
import { studiesQuery, type StudySummary } from '@/api';
import { marked, say } from '@/language';
import { Badge, DataTable, Notice, Progress, useTitle, type DataColumn } from '@/ui';
import { formatCount, formatDateTime, isoDateTime } from '@/units';
import styles from './studies-page.module.css';

type State = 'complete' | 'paused' | 'running';
const kStates = { complete: marked('complete'), paused: marked('paused'), running: marked('running') } as const;
const kTones = { complete: 'good', paused: 'warn', running: 'accent' } as const;

const stateOf = (study: StudySummary): State =>
  study.planned > 0 && study.done === study.planned ? 'complete' : study.state === 'paused' ? 'paused' : 'running';

const kColumns: readonly DataColumn<StudySummary>[] = [
  {
    name: marked('Study'),
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
  {
    name: marked('State'),
    by: (study) => say(kStates[stateOf(study)]),
    cell: (study) => <Badge tone={kTones[stateOf(study)]}>{say(kStates[stateOf(study)])}</Badge>,
  },
  {
    name: marked('Participants'),
    by: (study) => study.participants,
    cell: (study) => formatCount(study.participants),
    number: true,
  },
  {
    name: marked('Trials done'),
    by: (study) => study.done,
    cell: (study) => (
      <span className={styles.progress}>
        <Progress
          done={study.done}
          of={study.planned}
          label={say('{done} of {planned} trials done', {
            done: formatCount(study.done),
            planned: formatCount(study.planned),
          })}
        />
        <span>
          {say('{done} of {planned}', { done: formatCount(study.done), planned: formatCount(study.planned) })}
        </span>
      </span>
    ),
  },
  {
    name: marked('Created'),
    by: (study) => study.made_utc_us,
    cell: (study) => (
      <>
        <time dateTime={isoDateTime(study.made_utc_us)}>{formatDateTime(study.made_utc_us)}</time>, {study.made_by}
      </>
    ),
  },
];

export function StudiesPage() {
  useTitle(say('Studies'));
  const query = useQuery(studiesQuery);
  return (
    <>
      <div className={styles.head}>
        <h1>{say('Studies')}</h1>
        <Link href="/studies/new" className={styles.make}>
          {say('New study')}
        </Link>
      </div>
      {query.isError ? (
        <div className={styles.error}>
          <Notice
            tone="bad"
            title={query.data ? say('The list could not be refreshed.') : say('The studies could not be loaded.')}
            onRetry={() => void query.refetch()}
          >
            {query.error.message}
          </Notice>
        </div>
      ) : null}
      {query.data?.studies.length === 0 ? (
        <Notice title={say('No studies yet.')}>
          {say(
            'In a study, all participants do the same scenarios, blinded, each in an individual order. Create the first one.',
          )}
        </Notice>
      ) : query.data || query.isPending ? (
        <DataTable
          caption={say('Studies')}
          order={say('newest first')}
          className={styles.frame}
          rows={query.data?.studies}
          keyOf={({ id }) => id}
          empty={say('No studies yet.')}
          filter={{ label: say('Filter by title or short name'), text: (study) => `${study.title} ${study.id}` }}
          columns={kColumns}
        />
      ) : null}
    </>
  );
}
