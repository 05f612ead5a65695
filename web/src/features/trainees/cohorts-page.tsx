import { useQuery } from '@tanstack/react-query';
import { useState } from 'react';
import { Link } from 'wouter';
import { cohortProgressQuery } from '@/api';
import { say } from '@/language';
import { Badge, Card, DataTable, Notice, Select, Skeleton, Term, useTitle } from '@/ui';
import { formatCount, formatDateTime, formatShare, kNone } from '@/units';
import { CohortChart } from './cohort-chart';
import { isAway, membersOf, type Member } from './standing';
import { kBehind } from './terms';
import styles from './trainees.module.css';

const kDays = [14, 30, 60, 90];
type Show = 'all' | 'behind' | 'away';

/** Cohorts beside one another: their learning curves, who is behind, and who has not come for a while. */
export function CohortsPage() {
  useTitle(say('Cohorts'));
  const query = useQuery(cohortProgressQuery);
  const [days, setDays] = useState(30);
  const [show, setShow] = useState<Show>('all');
  const [cohort, setCohort] = useState('');
  const [now] = useState(() => Date.now() * 1000);
  const cohorts = query.data?.cohorts;
  const all = cohorts && membersOf(cohorts);
  const isShown = (one: Member) =>
    (cohort === '' || one.cohort === cohort) &&
    (show === 'all' || (show === 'behind' ? one.behind : isAway(one, days, now)));
  const behind = all?.filter((one) => one.behind).length ?? 0,
    away = all?.filter((one) => isAway(one, days, now)).length ?? 0;
  return (
    <div className={styles.page}>
      <p className={styles.back}>
        <Link href="/trainees">← {say('Trainees')}</Link>
      </p>
      <div>
        <h1>{say('Cohorts')}</h1>
        <p className={styles.lead}>
          {say('How cohorts learn, who is behind the others of the cohort, and who has not come for a while.')}
        </p>
      </div>
      {query.isError ? (
        <Notice tone="bad" title={say('The cohorts could not be loaded.')} onRetry={() => void query.refetch()}>
          {query.error.message}
        </Notice>
      ) : null}
      <Card title={say('Correct answers by running trial number')}>
        {cohorts ? (
          cohorts.some(({ bins }) => bins.length > 0) ? (
            <CohortChart cohorts={cohorts} />
          ) : (
            <p className={styles.muted}>
              {cohorts.length === 0 ? say('There are no cohorts yet.') : say('No trainee has five scored trials yet.')}
            </p>
          )
        ) : query.isPending ? (
          <Skeleton height="400px" />
        ) : null}
      </Card>
      <Card
        title={
          all
            ? say('{behind} behind, {away} away', { behind: formatCount(behind), away: formatCount(away) })
            : say('Trainees')
        }
        aside={
          <span className={styles.tools}>
            <Select
              label={say('Cohort')}
              value={cohort}
              onChange={(event) => setCohort(event.target.value)}
              options={[
                { value: '', text: say('All') },
                ...(cohorts ?? []).map(({ name }) => ({ value: name, text: name })),
              ]}
            />
            <Select
              label={say('Show')}
              value={show}
              onChange={(event) => setShow(event.target.value as Show)}
              options={[
                { value: 'all', text: say('All') },
                { value: 'behind', text: say('Behind') },
                { value: 'away', text: say('Away') },
              ]}
            />
            <Select
              label={say('Away means no trial for')}
              value={String(days)}
              onChange={(event) => setDays(Number(event.target.value))}
              options={kDays.map((one) => ({ value: String(one), text: say('{count} days', { count: one }) }))}
            />
          </span>
        }
      >
        <DataTable<Member>
          address=""
          caption={say('Trainees of the cohorts')}
          order={say('behind first, then longest away')}
          minWidth={760}
          rows={all?.filter(isShown)}
          keyOf={(one) => `${one.cohort} ${one.trainee}`}
          filter={{ label: say('Search by name'), text: (one) => one.trainee }}
          empty={all?.length === 0 ? say('No trainees yet.') : say('No trainees match the filter.')}
          columns={[
            {
              name: say('Trainee'),
              by: (one) => one.trainee,
              cell: (one) =>
                one.trials === 0 ? (
                  one.trainee
                ) : (
                  <Link href={`/trainees/${encodeURIComponent(one.trainee)}`}>{one.trainee}</Link>
                ),
            },
            { name: say('Cohort'), by: (one) => one.cohort, cell: (one) => one.cohort },
            { name: say('Trials'), by: (one) => one.trials, cell: (one) => formatCount(one.trials), number: true },
            {
              name: say('Correct of the last ten'),
              by: (one) => (one.recent_trials === 0 ? null : one.recent_right / one.recent_trials),
              cell: (one) =>
                one.recent_trials === 0
                  ? kNone
                  : `${formatCount(one.recent_right)} of ${formatCount(one.recent_trials)}`,
              number: true,
            },
            {
              name: <Term definition={say(kBehind)}>{say('Others then')}</Term>,
              title: say('Others then'),
              by: (one) => one.others_share,
              cell: (one) => (
                <>
                  {one.others_share === null ? kNone : formatShare(one.others_share)}{' '}
                  {one.behind ? <Badge tone="bad">{say('behind')}</Badge> : null}
                </>
              ),
            },
            {
              name: say('Last trial'),
              by: (one) => one.last_utc_us,
              cell: (one) => (
                <>
                  {one.last_utc_us === null ? say('none yet') : formatDateTime(one.last_utc_us)}{' '}
                  {isAway(one, days, now) ? <Badge tone="warn">{say('away')}</Badge> : null}
                </>
              ),
            },
          ]}
        />
      </Card>
    </div>
  );
}
