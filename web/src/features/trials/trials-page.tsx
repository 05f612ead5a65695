import { useQuery } from '@tanstack/react-query';
import { useLocation, useSearch } from 'wouter';
import { kTrialsPerPage, trialsQuery } from '@/api';
import { Field, Notice, Pages, Select, useSettled, useTitle } from '@/ui';
import { formatCount } from '@/units';
import { fromAddress, kAnswers, toAddress, type TrialView } from './search';
import styles from './trials-page.module.css';
import { TrialsTable } from './trials-table';

/** Trials, searched, sorted and handed out page by page by the server; what is shown is in the address. */
export function TrialsPage() {
  useTitle('Trials');
  const search = useSearch();
  const [path, go] = useLocation();
  const view = fromAddress(search);
  const change = (next: Partial<TrialView>) => {
    const parameters = toAddress({ ...view, page: 0, ...next });
    go(parameters === '' ? path : `${path}?${parameters}`, { replace: true });
  };
  const asked = useSettled(view.search, 250);
  const query = useQuery(trialsQuery({ ...view, search: asked.trim() }));
  const { trials, total = 0 } = query.data ?? {};
  const assessing = trials?.filter((trial) => trial.state === 'assessing').length ?? 0;
  const narrowed = view.search !== '' || view.answer !== 'any';
  return (
    <>
      <div className={styles.head}>
        <h1>Trials</h1>
        <p role="status" className={styles.count}>
          {trials === undefined
            ? ''
            : `${formatCount(total)} ${narrowed ? 'found' : 'in all'}${assessing > 0 ? `, ${formatCount(assessing)} being assessed` : ''}`}
        </p>
      </div>
      {query.isError ? (
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
      <div className={styles.find}>
        <Field
          label="Find by person, case or station"
          type="search"
          value={view.search}
          maxLength={100}
          onChange={(event) => change({ search: event.target.value })}
        />
        <Select
          label="Answer"
          value={view.answer}
          options={kAnswers.map(({ value, text }) => ({ value, text }))}
          onChange={(event) => {
            const next = kAnswers.find(({ value }) => value === event.target.value);
            if (next) change({ answer: next.value });
          }}
        />
      </div>
      {trials?.length === 0 && !narrowed ? (
        <Notice title="No trials yet.">A trial appears here after a station has uploaded it completely.</Notice>
      ) : trials !== undefined || query.isPending ? (
        <TrialsTable trials={trials} view={view} onSort={(sort, order) => change({ sort, order })} />
      ) : null}
      {total > kTrialsPerPage ? (
        <Pages
          label="Pages: Trials"
          page={view.page}
          size={kTrialsPerPage}
          of={total}
          onPage={(page) => change({ page })}
        />
      ) : null}
    </>
  );
}
