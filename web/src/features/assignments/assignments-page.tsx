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
import { marked, say } from '@/language';
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
  name: marked('Assignment'),
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
  name: say('Due'),
  sort: 'due',
  by: (one) => one.due_utc_us,
  cell: (one) => <DueDate one={one} now_us={now_us} />,
});
const doneColumn: AssignmentColumn = {
  name: marked('Done'),
  by: (one) => one.done / one.planned,
  cell: (one) => (
    <Done done={one.done} planned={one.planned} label={say('Trials done of {title}', { title: one.title })} />
  ),
};
const resultsColumn: AssignmentColumn = {
  name: marked('Results'),
  by: ({ release }) => say(kReleaseLabels[release].name),
  cell: ({ release }) => (
    <Badge tone={release === 'held' ? 'neutral' : 'good'}>{say(kReleaseLabels[release].name)}</Badge>
  ),
};

const kFilters: readonly ListFilter[] = [
  {
    name: 'state',
    label: marked('State'),
    choices: [
      { value: 'unfinished', text: marked('unfinished') },
      { value: 'finished', text: marked('finished') },
    ],
  },
  {
    name: 'release',
    label: marked('Results'),
    choices: (['held', 'released', 'at_once'] as const).map((value) => ({ value, text: kReleaseLabels[value].name })),
  },
];

function Failed({ message, onRetry }: { readonly message: string; readonly onRetry: () => void }) {
  return (
    <Notice tone="bad" title={say('The assignments could not be loaded.')} onRetry={onRetry}>
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
      <Card title={say('To do')}>
        <DataTable<AssignmentSummary>
          caption={say('Assignments to do')}
          rows={all?.filter((one) => one.done < one.planned)}
          keyOf={({ id }) => id}
          empty={say('No open assignments.')}
          columns={[nameColumn, dueColumn(now_us), doneColumn]}
        />
      </Card>
      <Card title={say('Done')}>
        <DataTable<AssignmentSummary>
          caption={say('Assignments done')}
          rows={all?.filter((one) => one.done >= one.planned)}
          keyOf={({ id }) => id}
          empty={say('No completed assignments yet.')}
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
    <Card title={say('Assignments')}>
      <ListTable<AssignmentSummary>
        caption={say('Assignments')}
        list={list}
        page={query.data}
        views={views}
        usual="urgency"
        searchLabel={say('Find by assignment, cohort or creator')}
        filters={kFilters}
        rows={query.data?.assignments}
        keyOf={({ id }) => id}
        empty={may ? say('No assignments yet. Create a new assignment.') : say('No assignments yet.')}
        minWidth={760}
        columns={[
          nameColumn,
          { name: say('Cohort'), sort: 'cohort', cell: (one) => one.cohort_name || '–' },
          { name: say('Trainees'), cell: (one) => formatCount(one.people ?? 0), number: true },
          dueColumn(now_us),
          doneColumn,
          resultsColumn,
          {
            name: say('Created'),
            sort: 'made',
            falls: true,
            cell: (one) => say('{time} by {name}', { time: formatDateTime(one.made_utc_us), name: one.made_by }),
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
  useTitle(own ? say('My work') : say('Assignments'));
  return (
    <div className={styles.page}>
      <div className={styles.top}>
        <div>
          <h1>{own ? say('My work') : say('Assignments')}</h1>
          <p className={styles.lead}>
            {own
              ? say(
                  'Your assignments, their due dates and their results. Sign in at a station with your badge and PIN; the station then offers your next trial.',
                )
              : say(
                  'Cases assigned to trainees, their due dates, and who may see the results. After badge and PIN, a station offers the next case under a blind name.',
                )}
          </p>
        </div>
        {may ? (
          <span className={styles.buttons}>
            <Link href="/curricula">{say('Curricula')}</Link>
            <Link href="/assignments/new" className={styles.solid}>
              {say('New assignment')}
            </Link>
          </span>
        ) : null}
      </div>
      {own || role === 'faculty' ? <Invitations /> : null}
      {own ? <OwnAssignments now_us={now_us} /> : <TaughtAssignments now_us={now_us} may={may} />}
    </div>
  );
}
