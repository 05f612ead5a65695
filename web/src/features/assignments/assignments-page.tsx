import { useQuery } from '@tanstack/react-query';
import { useState } from 'react';
import { Link } from 'wouter';
import { assignmentsQuery, sessionQuery, type AssignmentSummary } from '@/api';
import { Badge, Card, DataTable, Notice, useTitle, type DataColumn } from '@/ui';
import { formatCount } from '@/units';
import styles from './assignments.module.css';
import { Invitations } from './invitations';
import { Done, Drilling, DueDate } from './parts';
import { byUrgency, kReleaseLabels } from './labels';

const releaseName = ({ release }: AssignmentSummary) => kReleaseLabels[release].name;
const releaseCell = (one: AssignmentSummary) => (
  <Badge tone={one.release === 'held' ? 'neutral' : 'good'}>{releaseName(one)}</Badge>
);

/** Assignments of one's trainees, or of the trainee who is signed in. */
export function AssignmentsPage() {
  const query = useQuery(assignmentsQuery);
  const role = useQuery({ ...sessionQuery, enabled: false }).data?.role;
  const [now_us] = useState(() => Date.now() * 1000);
  const own = role === 'trainee';
  const may = role === 'admin' || role === 'faculty';
  useTitle(own ? 'My work' : 'Assignments');
  const name: DataColumn<AssignmentSummary> = {
    name: 'Assignment',
    by: (one) => one.title,
    cell: (one) => (
      <>
        <Link href={`/assignments/${one.id}`}>{one.title}</Link>
        <div>
          <Drilling one={one} />
        </div>
      </>
    ),
  };
  const due: DataColumn<AssignmentSummary> = {
    name: 'Due',
    by: (one) => one.due_utc_us,
    cell: (one) => <DueDate one={one} now_us={now_us} />,
  };
  const done: DataColumn<AssignmentSummary> = {
    name: 'Done',
    by: (one) => one.done / one.planned,
    cell: (one) => <Done done={one.done} planned={one.planned} label={`Trials done of ${one.title}`} />,
  };
  const all = query.data && byUrgency(query.data.assignments);
  const open = all?.filter((one) => one.done < one.planned),
    over = all?.filter((one) => one.done >= one.planned);
  return (
    <div className={styles.page}>
      <div className={styles.top}>
        <div>
          <h1>{own ? 'My work' : 'Assignments'}</h1>
          <p className={styles.lead}>
            {own
              ? 'Your assignments, their due dates and their results. Sign in at a station with your badge and PIN; the station then offers your next trial.'
              : 'Cases assigned to trainees, their due dates, and who may see the results. After badge and PIN, a station offers the next case under a blind name.'}
          </p>
        </div>
        {may ? (
          <span className={styles.buttons}>
            <Link href="/curricula">Curricula</Link>
            <Link href="/assignments/new" className={styles.solid}>
              New assignment
            </Link>
          </span>
        ) : null}
      </div>
      {query.isError ? (
        <Notice tone="bad" title="The assignments could not be loaded." onRetry={() => void query.refetch()}>
          {query.error.message}
        </Notice>
      ) : null}
      {own || role === 'faculty' ? <Invitations /> : null}
      {query.isError ? null : own ? (
        <>
          <Card title="To do">
            <DataTable<AssignmentSummary>
              caption="Assignments to do"
              rows={open}
              keyOf={({ id }) => id}
              empty="No open assignments."
              columns={[name, due, done]}
            />
          </Card>
          <Card title="Done">
            <DataTable<AssignmentSummary>
              caption="Assignments done"
              rows={over}
              keyOf={({ id }) => id}
              empty="No completed assignments yet."
              columns={[name, done, { name: 'Results', by: releaseName, cell: releaseCell }]}
            />
          </Card>
        </>
      ) : (
        <Card title="Assignments">
          <DataTable<AssignmentSummary>
            caption="Assignments"
            order="unfinished first, the earliest due first"
            address=""
            rows={all}
            keyOf={({ id }) => id}
            empty={may ? 'No assignments yet. Create a new assignment.' : 'No assignments yet.'}
            minWidth={760}
            filter={{ label: 'Filter by assignment or cohort', text: (one) => `${one.title} ${one.cohort_name}` }}
            columns={[
              name,
              { name: 'Cohort', by: (one) => one.cohort_name, cell: (one) => one.cohort_name || '–' },
              { name: 'Trainees', by: (one) => one.people, cell: (one) => formatCount(one.people ?? 0), number: true },
              due,
              done,
              { name: 'Results', by: releaseName, cell: releaseCell },
              { name: 'Created by', by: (one) => one.made_by, cell: (one) => one.made_by },
            ]}
          />
        </Card>
      )}
    </div>
  );
}
