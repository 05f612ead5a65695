import { useQuery } from '@tanstack/react-query';
import { useState } from 'react';
import { Link } from 'wouter';
import { traineesQuery, type TraineeSummary } from '@/api';
import { Badge, Card, DataTable, Notice, Select, Term, useTitle } from '@/ui';
import { formatCount, formatDateTime, formatShare } from '@/units';
import { Whisker } from './recognition';
import { isInactive, shownOf, type Show } from './standing';
import styles from './trainees.module.css';
import { kCusum, kInterval, kStateLabels } from './terms';

/** The list of trainees, filtered by state. */
export function TraineesPage() {
  useTitle('Trainees');
  const query = useQuery(traineesQuery);
  const [show, setShow] = useState<Show>('all');
  const [now] = useState(() => Date.now() * 1000);
  const all = query.data?.trainees;
  const tally = (state: Show) => formatCount(all ? shownOf(all, state, now).length : 0);
  const rule = query.data?.rule;
  return (
    <div className={styles.page}>
      <div className={styles.head}>
        <div>
          <h1>Trainees</h1>
          <p className={styles.lead}>
            Which trainees are on track, have relapsed, or have had no trial for two months.
          </p>
        </div>
        <Link href="/cohorts">Cohorts</Link>
      </div>
      {query.isError ? (
        <Notice tone="bad" title="The trainees could not be loaded." onRetry={() => void query.refetch()}>
          {query.error.message}
        </Notice>
      ) : null}
      <Card
        title={all ? `${formatCount(all.length)} ${all.length === 1 ? 'trainee' : 'trainees'}` : 'Trainees'}
        aside={
          <span className={styles.pick}>
            <Select
              label={<span className="hidden-visually">Filter</span>}
              value={show}
              onChange={(event) => setShow(event.target.value as Show)}
              options={[
                { value: 'all', text: 'All' },
                { value: 'relapsed', text: `Relapsed (${tally('relapsed')})` },
                { value: 'learning', text: `Learning (${tally('learning')})` },
                { value: 'competent', text: `Competent (${tally('competent')})` },
                { value: 'inactive', text: `Inactive for two months (${tally('inactive')})` },
              ]}
            />
          </span>
        }
      >
        <DataTable<TraineeSummary>
          address=""
          caption="Trainees"
          minWidth={820}
          rows={all && shownOf(all, show, now)}
          keyOf={({ trainee }) => trainee}
          filter={{ label: 'Search by name', text: (one) => one.trainee }}
          empty={all?.length === 0 ? 'No scored trials yet.' : 'No trainees match the filter.'}
          columns={[
            {
              name: 'Trainee',
              by: (one) => one.trainee,
              cell: (one) => (
                <>
                  <Link href={`/trainees/${encodeURIComponent(one.trainee)}`}>{one.trainee}</Link>{' '}
                  {one.simulated ? <Badge tone="warn">simulated</Badge> : null}
                </>
              ),
            },
            {
              name: <Term definition={kCusum}>State</Term>,
              title: 'State',
              by: (one) => kStateLabels[one.state].label,
              cell: (one) => <Badge tone={kStateLabels[one.state].tone}>{kStateLabels[one.state].label}</Badge>,
            },
            { name: 'Trials', by: (one) => one.trials, cell: (one) => formatCount(one.trials), number: true },
            {
              name: <Term definition={kInterval}>Correct</Term>,
              title: 'Correct',
              by: (one) => one.share,
              cell: (one) => (
                <span className={styles.interval}>
                  <Whisker value={one.share} low={one.wilson_low} high={one.wilson_high} />
                  <span>
                    {formatShare(one.share)} ({formatShare(one.wilson_low)}–{formatShare(one.wilson_high)})
                  </span>
                </span>
              ),
            },
            { name: 'Next', by: (one) => one.next.scenario, cell: (one) => one.next.scenario },
            {
              name: 'Last trial',
              by: (one) => one.last_utc_us,
              cell: (one) => (
                <>
                  {formatDateTime(one.last_utc_us)} {isInactive(one, now) ? <Badge tone="warn">inactive</Badge> : null}
                </>
              ),
            },
          ]}
        />
        {rule ? (
          <p className={styles.muted}>
            Assessed with failure rates of {formatShare(rule.adequate)} (adequate) and {formatShare(rule.inadequate)}{' '}
            (inadequate).{' '}
            {rule.trials === 0
              ? 'No number of trials can distinguish the two.'
              : `Certification needs at least ${formatCount(rule.trials)} trials.`}
          </p>
        ) : null}
      </Card>
    </div>
  );
}
