import { useQuery } from '@tanstack/react-query';
import { trialsAsked, trialsQuery, useSavedViews } from '@/api';
import { say } from '@/language';
import { Notice, useList, useTitle } from '@/ui';
import { formatCount } from '@/units';
import styles from './trials-page.module.css';
import { TrialsTable } from './trials-table';

/** Trials, searched, sorted and handed out page by page by the server; what is shown is in the address. */
export function TrialsPage() {
  useTitle(say('Trials'));
  const list = useList(trialsAsked);
  const query = useQuery(trialsQuery(list.query));
  const views = useSavedViews('trials');
  const { trials } = query.data ?? {};
  const assessing = trials?.filter((trial) => trial.state === 'assessing').length ?? 0;
  return (
    <>
      <div className={styles.head}>
        <h1>{say('Trials')}</h1>
      </div>
      {query.isError ? (
        <div className={styles.error}>
          <Notice
            tone="bad"
            title={trials ? say('The list could not be refreshed.') : say('The trials could not be loaded.')}
            onRetry={() => void query.refetch()}
          >
            {query.error.message}
          </Notice>
        </div>
      ) : null}
      {trials !== undefined || query.isPending ? (
        <TrialsTable
          trials={trials}
          page={query.data}
          list={list}
          views={views}
          remark={
            assessing > 0 ? `, ${say('{count} on this page being assessed', { count: formatCount(assessing) })}` : ''
          }
        />
      ) : null}
    </>
  );
}
