import { useQuery } from '@tanstack/react-query';
import { useState } from 'react';
import { Link } from 'wouter';
import { assignmentsQuery, sessionQuery, type AssignmentSummary } from '@/api';
import { Badge, Card, Notice, Table, useTitle, type Column } from '@/ui';
import { formatCount } from '@/units';
import styles from './assignments.module.css';
import { Invitations } from './invitations';
import { Done, Drilling, DueDate } from './parts';
import { kReleaseWords } from './words';

const releaseCell = (one: AssignmentSummary) => <Badge tone={one.release === 'held' ? 'neutral' : 'good'}>{kReleaseWords[one.release].name}</Badge>;

/** What is to be done: by those one teaches, or by oneself. */
export function AssignmentsPage() {
  const query = useQuery(assignmentsQuery);
  const role = useQuery({ ...sessionQuery, enabled: false }).data?.role;
  const [now_us] = useState(() => Date.now() * 1000);
  const own = role === 'trainee';
  const may = role === 'admin' || role === 'faculty';
  useTitle(own ? 'My work' : 'Assignments');
  const name: Column<AssignmentSummary> = { name: 'Assignment', cell: (one) => <><Link href={`/assignments/${one.id}`}>{one.title}</Link><div><Drilling one={one} /></div></> };
  const due: Column<AssignmentSummary> = { name: 'Due', cell: (one) => <DueDate one={one} now_us={now_us} /> };
  const done: Column<AssignmentSummary> = { name: 'Done', cell: (one) => <Done done={one.done} planned={one.planned} label={`Trials done of ${one.title}`} /> };
  const all = query.data?.assignments;
  const open = all?.filter((one) => one.done < one.planned), over = all?.filter((one) => one.done >= one.planned);
  return (
    <div className={styles.page}>
      <div className={styles.top}>
        <div>
          <h1>{own ? 'My work' : 'Assignments'}</h1>
          <p className={styles.lead}>{own
            ? 'What you are to do at a station, until when, and what came of it. Sign in at a station with your badge and PIN: it knows what comes next.'
            : 'Who is to do which cases, until when, and who may see the results. A station hands out the next case after badge and PIN, under a blind name.'}</p>
        </div>
        {may ? <Link href="/assignments/new" className={styles.solid}>New assignment</Link> : null}
      </div>
      {query.isError ? <Notice tone="bad" title="The assignments could not be loaded." onRetry={() => void query.refetch()}>{query.error.message}</Notice> : null}
      {own || role === 'faculty' ? <Invitations /> : null}
      {query.isError ? null : own ? (
        <>
          <Card title="To do"><Table<AssignmentSummary> caption="Assignments to do" rows={open} keyOf={({ id }) => id} empty="Nothing is left to do." columns={[name, due, done]} /></Card>
          <Card title="Done"><Table<AssignmentSummary> caption="Assignments done" rows={over} keyOf={({ id }) => id} empty="Nothing is done yet." columns={[name, done, { name: 'Results', cell: releaseCell }]} /></Card>
        </>
      ) : (
        <Card title="Assignments">
          <Table<AssignmentSummary> caption="Assignments" rows={all} keyOf={({ id }) => id} empty={may ? 'Nothing is assigned yet. Begin with a new assignment.' : 'Nothing is assigned yet.'} minWidth={760} columns={[
            name, { name: 'Cohort', cell: (one) => one.cohort_name || '–' }, { name: 'Trainees', cell: (one) => formatCount(one.people ?? 0), number: true }, due, done,
            { name: 'Results', cell: releaseCell }, { name: 'Made by', cell: (one) => one.made_by },
          ]} />
        </Card>
      )}
    </div>
  );
}
