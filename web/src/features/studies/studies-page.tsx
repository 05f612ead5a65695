import { useQuery } from '@tanstack/react-query';
import { Link } from 'wouter';
import { studiesQuery, type StudySummary } from '@/api';
import { Badge, Notice, Progress, Skeleton, useTitle } from '@/ui';
import { formatCount, formatDateTime, isoDateTime } from '@/units';
import styles from './studies-page.module.css';

const kColumns = ['Study', 'State', 'Participants', 'Trials done', 'Created'] as const;
const kWaiting = 4;

function Row({ study }: { readonly study: StudySummary }) {
  return (
    <tr>
      <td>
        <Link href={`/studies/${encodeURIComponent(study.id)}`} className={styles.link}>
          {study.title}
        </Link>{' '}
        <span className={styles.id}>{study.id}</span>
      </td>
      <td>
        {study.planned > 0 && study.done === study.planned ? (
          <Badge tone="good">complete</Badge>
        ) : study.state === 'paused' ? (
          <Badge tone="warn">paused</Badge>
        ) : (
          <Badge tone="accent">running</Badge>
        )}
      </td>
      <td className={styles.number}>{formatCount(study.participants)}</td>
      <td>
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
      </td>
      <td>
        <time dateTime={isoDateTime(study.made_utc_us)}>{formatDateTime(study.made_utc_us)}</time>, {study.made_by}
      </td>
    </tr>
  );
}

function Table({ studies }: { readonly studies: readonly StudySummary[] | undefined }) {
  return (
    <div className={styles.frame}>
      <table className={styles.table} aria-busy={studies === undefined}>
        <caption className="hidden-visually">Studies, newest first</caption>
        <thead>
          <tr>
            {kColumns.map((column) => (
              <th key={column} scope="col" className={column === 'Participants' ? styles.number : undefined}>
                {column}
              </th>
            ))}
          </tr>
        </thead>
        <tbody>
          {studies === undefined
            ? Array.from({ length: kWaiting }, (_, i) => (
                <tr key={i}>
                  {kColumns.map((column) => (
                    <td key={column}>
                      <Skeleton width="80%" />
                    </td>
                  ))}
                </tr>
              ))
            : studies.map((study) => <Row key={study.id} study={study} />)}
        </tbody>
      </table>
    </div>
  );
}

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
        <Table studies={query.data?.studies} />
      ) : null}
    </>
  );
}
