import { useQuery } from '@tanstack/react-query';
import { useState } from 'react';
import { Link } from 'wouter';
import { traineesQuery, type TraineeSummary } from '@/api';
import { Badge, Card, Field, Notice, Select, Table, Term, useTitle } from '@/ui';
import { formatCount, formatDateTime, formatShare } from '@/units';
import { Whisker } from './recognition';
import { isDue, shownOf, type Show } from './standing';
import styles from './trainees.module.css';
import { kCusum, kInterval, kState } from './words';

/** Who is on track, who relapsed, who is due. */
export function TraineesPage() {
  useTitle('Trainees');
  const query = useQuery(traineesQuery);
  const [show, setShow] = useState<Show>('all');
  const [search, setSearch] = useState('');
  const [now] = useState(() => Date.now() * 1000);
  const all = query.data?.trainees;
  const tally = (state: Show) => formatCount(all ? shownOf(all, state, '', now).length : 0);
  const rule = query.data?.rule;
  return (
    <div className={styles.page}>
      <div><h1>Trainees</h1><p className={styles.lead}>Who is on track, who has relapsed, who has not been at a station for two months.</p></div>
      {query.isError ? <Notice tone="bad" title="The trainees could not be loaded." onRetry={() => void query.refetch()}>{query.error.message}</Notice> : null}
      <Card title={all ? `${formatCount(all.length)} ${all.length === 1 ? 'trainee' : 'trainees'}` : 'Trainees'} aside={
        <span className={styles.tools}>
          <Select label={<span className="hidden-visually">Shown</span>} value={show} onChange={(event) => setShow(event.target.value as Show)} options={[
            { value: 'all', text: 'All' }, { value: 'relapsed', text: `Relapsed (${tally('relapsed')})` }, { value: 'learning', text: `Learning (${tally('learning')})` },
            { value: 'competent', text: `Competent (${tally('competent')})` }, { value: 'due', text: `Due (${tally('due')})` }]} />
          <Field label={<span className="hidden-visually">Find a name</span>} placeholder="Find a name" type="search" value={search} onChange={(event) => setSearch(event.target.value)} />
        </span>
      }>
        <Table<TraineeSummary> caption="Trainees" minWidth={820} rows={all && shownOf(all, show, search, now)} keyOf={({ trainee }) => trainee}
          empty={all?.length === 0 ? 'Nobody has a scored trial yet.' : 'Nobody is like that.'} columns={[
            { name: 'Trainee', cell: (one) => <><Link href={`/trainees/${encodeURIComponent(one.trainee)}`}>{one.trainee}</Link> {one.simulated ? <Badge tone="warn">simulated</Badge> : null}</> },
            { name: <Term definition={kCusum}>State</Term>, cell: (one) => <Badge tone={kState[one.state].tone}>{kState[one.state].word}</Badge> },
            { name: 'Trials', cell: (one) => formatCount(one.trials), number: true },
            { name: <Term definition={kInterval}>Right</Term>, cell: (one) => <span className={styles.interval}><Whisker value={one.share} low={one.wilson_low} high={one.wilson_high} /><span>{formatShare(one.share)} ({formatShare(one.wilson_low)}–{formatShare(one.wilson_high)})</span></span> },
            { name: 'Next', cell: (one) => one.next.scenario },
            { name: 'Last trial', cell: (one) => <>{formatDateTime(one.last_utc_us)} {isDue(one, now) ? <Badge tone="warn">due</Badge> : null}</> },
          ]} />
        {rule ? <p className={styles.muted}>Judged by failure rates of {formatShare(rule.adequate)} (adequate) and {formatShare(rule.inadequate)} (inadequate). {rule.trials === 0 ? 'No number of trials tells them apart.' : `It takes at least ${formatCount(rule.trials)} trials to certify anybody.`}</p> : null}
      </Card>
    </div>
  );
}
