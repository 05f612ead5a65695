import { useQuery } from '@tanstack/react-query';
import { useState } from 'react';
import { Link } from 'wouter';
import {
  allAssignmentsQuery,
  assignmentsAsked,
  assignmentsQuery,
  sessionQuery,
  useSavedViews,
  type AssignmentSummary,
} from '@/api';
import {
  Badge,
  Card,
  DataTable,
  ListTable,
  Notice,
  useList,
  useTitle,
  type DataColumn,
  type ListColumn,
  type ListFilter,
} from '@/ui';
import { formatCount, formatDateTime } from '@/units';
import styles from './assignments.module.css';
import { Invitations } from './invitations';
import { Done, Drilling, DueDate } from './parts';
import { kReleaseLabels } from './labels';

/** Sorted by the server in a long list, here in a short one. */
type AssignmentColumn = ListColumn<AssignmentSummary> & DataColumn<AssignmentSummary>;

const nameColumn: AssignmentColumn = {
  name: 'Assignment',
  sort: 'title',
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
const dueColumn = (now_us: number): AssignmentColumn => ({
  name: 'Due',
  sort: 'due',
  by: (one) => one.due_utc_us,
  cell: (one) => <DueDate one={one} now_us={now_us} />,
});
const doneColumn: AssignmentColumn = {
  name: 'Done',
  by: (one) => one.done / one.planned,
  cell: (one) => <Done done={one.done} planned={one.planned} label={`Trials done of ${one.title}`} />,
};
const resultsColumn: AssignmentColumn = {
  name: 'Results',
  by: ({ release }) => kReleaseLabels[release].name,
  cell: ({ release }) => <Badge tone={release === 'held' ? 'neutral' : 'good'}>{kReleaseLabels[release].name}</Badge>,
};

const kFilters: readonly ListFilter[] = [
  {
    name: 'state',
    label: 'State',
    choices: [
      { value: 'unfinished', text: 'unfinished' },
      { value: 'finished', text: 'finished' },
    ],
  },
  {
    name: 'release',
    label: 'Results',
    choices: (['held', 'released', 'at_once'] as const).map((value) => ({ value, text: kReleaseLabels[value].name })),
  },
];

function Failed({ message, onRetry }: { readonly message: string; readonly onRetry: () => void }) {
  return (
    <Notice tone="bad" title="The assignments could not be loaded." onRetry={onRetry}>
      {message}
    </Notice>
  );
}

/** The assignments of the trainee who is signed in. */
function OwnAssignments({ now_us }: { readonly now_us: number }) {
  const query = useQuery(allAssignmentsQuery);
  if (query.isError) return <Failed message={query.error.message} onRetry={() => void query.refetch()} />;
  const all = query.data?.assignments;
  return (
    <>
      <Card title="To do">
        <DataTable<AssignmentSummary>
          caption="Assignments to do"
          rows={all?.filter((one) => one.done < one.planned)}
          keyOf={({ id }) => id}
          empty="No open assignments."
          columns={[nameColumn, dueColumn(now_us), doneColumn]}
        />
      </Card>
      <Card title="Done">
        <DataTable<AssignmentSummary>
          caption="Assignments done"
          rows={all?.filter((one) => one.done >= one.planned)}
          keyOf={({ id }) => id}
          empty="No completed assignments yet."
          columns={[nameColumn, doneColumn, resultsColumn]}
        />
      </Card>
    </>
  );
}

/** The assignments that those who teach may see: usually the unfinished ones first, the earliest due first. */
function TaughtAssignments({ now_us, may }: { readonly now_us: number; readonly may: boolean }) {
  const list = useList(assignmentsAsked);
  const query = useQuery(assignmentsQuery(list.query));
  const views = useSavedViews('assignments');
  if (query.isError) return <Failed message={query.error.message} onRetry={() => void query.refetch()} />;
  return (
    <Card title="Assignments">
      <ListTable<AssignmentSummary>
        caption="Assignments"
        list={list}
        page={query.data}
        views={views}
        usual="urgency"
        searchLabel="Find by assignment, cohort or creator"
        filters={kFilters}
        rows={query.data?.assignments}
        keyOf={({ id }) => id}
        empty={may ? 'No assignments yet. Create a new assignment.' : 'No assignments yet.'}
        minWidth={760}
        columns={[
          nameColumn,
          { name: 'Cohort', sort: 'cohort', cell: (one) => one.cohort_name || '–' },
          { name: 'Trainees', cell: (one) => formatCount(one.people ?? 0), number: true },
          dueColumn(now_us),
          doneColumn,
          resultsColumn,
          {
            name: 'Created',
            sort: 'made',
            falls: true,
            cell: (one) => `${formatDateTime(one.made_utc_us)} by ${one.made_by}`,
          },
        ]}
      />
    </Card>
  );
}

/** Assignments of one's trainees, or of the trainee who is signed in. */
export function AssignmentsPage() {
  const role = useQuery({ ...sessionQuery, enabled: false }).data?.role;
  const [now_us] = useState(() => Date.now() * 1000);
  const own = role === 'trainee';
  const may = role === 'admin' || role === 'faculty';
  useTitle(own ? 'My work' : 'Assignments');
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
      {own || role === 'faculty' ? <Invitations /> : null}
      {own ? <OwnAssignments now_us={now_us} /> : <TaughtAssignments now_us={now_us} may={may} />}
    </div>
  );
}
