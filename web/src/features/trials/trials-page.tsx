import { useInfiniteQuery } from '@tanstack/react-query';
import { trialsQuery } from '@/api';
import { Button, Notice, useTitle } from '@/ui';
import { formatCount } from '@/units';
import { TrialsTable } from './trials-table';
import styles from './trials-page.module.css';

export function TrialsPage() {
  useTitle('Trials');
  const query = useInfiniteQuery(trialsQuery);
  const trials = query.data?.pages.flatMap((page) => page.trials);
  const assessing = trials?.filter((trial) => trial.state === 'assessing').length ?? 0;
  return (
    <>
      <div className={styles.head}>
        <h1>Trials</h1>
        <p role="status" className={styles.count}>
          {trials === undefined
            ? ''
            : `${formatCount(trials.length)} shown${assessing > 0 ? `, ${formatCount(assessing)} being assessed` : ''}`}
        </p>
      </div>
      {query.isError && (trials === undefined || !query.isFetching) ? (
        <div className={styles.error}>
          <Notice
            tone="bad"
            title={trials ? 'The list could not be refreshed.' : 'The trials could not be loaded.'}
            onRetry={() => void query.refetch()}
          >
            {query.error.message}
          </Notice>
        </div>
      ) : null}
      {trials?.length === 0 ? (
        <Notice title="No trials yet.">A trial appears here after a station has uploaded it completely.</Notice>
      ) : trials !== undefined || query.isPending ? (
        <TrialsTable trials={trials} partial={query.hasNextPage} />
      ) : null}
      {query.hasNextPage ? (
        <div className={styles.more}>
          <Button onClick={() => void query.fetchNextPage()} disabled={query.isFetchingNextPage}>
            {query.isFetchingNextPage ? 'Loading…' : 'Show older trials'}
          </Button>
        </div>
      ) : null}
    </>
  );
}
