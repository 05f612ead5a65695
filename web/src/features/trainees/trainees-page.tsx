import { useQuery } from '@tanstack/react-query';
import { useState } from 'react';
import { Link } from 'wouter';
import { traineesQuery, type TraineeSummary } from '@/api';
import { say } from '@/language';
import { Badge, Card, DataTable, Notice, Select, Term, useTitle } from '@/ui';
import { formatCount, formatDateTime, formatShare } from '@/units';
import { Whisker } from './recognition';
import { isInactive, shownOf, type Show } from './standing';
import styles from './trainees.module.css';
import { kCusum, kInterval, kStateLabels } from './terms';

/** The list of trainees, filtered by state. */
export function TraineesPage() {
  useTitle(say('Trainees'));
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
          <h1>{say('Trainees')}</h1>
          <p className={styles.lead}>
            {say('Which trainees are on track, have relapsed, or have had no trial for two months.')}
          </p>
        </div>
        <Link href="/cohorts">{say('Cohorts')}</Link>
      </div>
      {query.isError ? (
        <Notice tone="bad" title={say('The trainees could not be loaded.')} onRetry={() => void query.refetch()}>
          {query.error.message}
        </Notice>
      ) : null}
      <Card
        title={
          all ? say('{count, plural, one {# trainee} other {# trainees}}', { count: all.length }) : say('Trainees')
        }
        aside={
          <span className={styles.pick}>
            <Select
              label={<span className="hidden-visually">{say('Filter')}</span>}
              value={show}
              onChange={(event) => setShow(event.target.value as Show)}
              options={[
                { value: 'all', text: say('All') },
                { value: 'relapsed', text: say('Relapsed ({count})', { count: tally('relapsed') }) },
                { value: 'learning', text: say('Learning ({count})', { count: tally('learning') }) },
                { value: 'competent', text: say('Competent ({count})', { count: tally('competent') }) },
                { value: 'inactive', text: say('Inactive for two months ({count})', { count: tally('inactive') }) },
              ]}
            />
          </span>
        }
      >
        <DataTable<TraineeSummary>
          address=""
          caption={say('Trainees')}
          minWidth={820}
          rows={all && shownOf(all, show, now)}
          keyOf={({ trainee }) => trainee}
          filter={{ label: say('Search by name'), text: (one) => one.trainee }}
          empty={all?.length === 0 ? say('No scored trials yet.') : say('No trainees match the filter.')}
          columns={[
            {
              name: say('Trainee'),
              by: (one) => one.trainee,
              cell: (one) => (
                <>
                  <Link href={`/trainees/${encodeURIComponent(one.trainee)}`}>{one.trainee}</Link>{' '}
                  {one.simulated ? <Badge tone="warn">{say('simulated')}</Badge> : null}
                </>
              ),
            },
            {
              name: <Term definition={say(kCusum)}>{say('State')}</Term>,
              title: say('State'),
              by: (one) => say(kStateLabels[one.state].label),
              cell: (one) => <Badge tone={kStateLabels[one.state].tone}>{say(kStateLabels[one.state].label)}</Badge>,
            },
            { name: say('Trials'), by: (one) => one.trials, cell: (one) => formatCount(one.trials), number: true },
            {
              name: <Term definition={say(kInterval)}>{say('Correct')}</Term>,
              title: say('Correct'),
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
            { name: say('Next'), by: (one) => one.next.scenario, cell: (one) => one.next.scenario },
            {
              name: say('Last trial'),
              by: (one) => one.last_utc_us,
              cell: (one) => (
                <>
                  {formatDateTime(one.last_utc_us)}{' '}
                  {isInactive(one, now) ? <Badge tone="warn">{say('inactive')}</Badge> : null}
                </>
              ),
            },
          ]}
        />
        {rule ? (
          <p className={styles.muted}>
            {say('Assessed with failure rates of {adequate} (adequate) and {inadequate} (inadequate).', {
              adequate: formatShare(rule.adequate),
              inadequate: formatShare(rule.inadequate),
            })}{' '}
            {rule.trials === 0
              ? say('No number of trials can distinguish the two.')
              : say('Certification needs at least {trials} trials.', { trials: formatCount(rule.trials) })}
          </p>
        ) : null}
      </Card>
    </div>
  );
}
