import { useMutation, useQuery, useQueryClient } from '@tanstack/react-query';
import { useState, type FormEvent } from 'react';
import { useSearch, Link } from 'wouter';
import {
  addCohort,
  addToCohort,
  cohortQuery,
  cohortsQuery,
  inviteIntoCohort,
  sessionQuery,
  removeFromCohort,
  type Cohort,
  type CohortSummary,
} from '@/api';
import { marked, say } from '@/language';
import { Badge, Button, Card, DataTable, Field, Notice, roleName, Skeleton } from '@/ui';
import { formatCount, formatDateTime } from '@/units';
import { Frame } from './frame';
import { InvitedPeople } from './invited';
import styles from './network.module.css';

function NewCohortForm() {
  const client = useQueryClient();
  const [name, setName] = useState('');
  const made = useMutation({
    mutationFn: addCohort,
    onSuccess: async () => {
      setName('');
      await client.invalidateQueries({ queryKey: cohortsQuery.queryKey });
    },
  });
  const submit = (event: FormEvent) => {
    event.preventDefault();
    made.mutate(name.trim());
  };
  return (
    <form className={styles.form} onSubmit={submit}>
      <Field
        label={say('Name of the new cohort')}
        value={name}
        required
        maxLength={100}
        placeholder={say('Residents 2027')}
        onChange={(event) => setName(event.target.value)}
      />
      <Button type="submit" disabled={made.isPending || name.trim() === ''}>
        {made.isPending ? say('Creating…') : say('Create cohort')}
      </Button>
      {made.isError ? (
        <p role="alert" className={styles.wide}>
          {say('The cohort was not created: {message}', { message: made.error.message })}
        </p>
      ) : null}
    </form>
  );
}

const mayChange = (role: string | undefined) => role === 'admin' || role === 'faculty';

type Person = Cohort['people'][number];

function Members({ id, role }: { readonly id: string; readonly role: string | undefined }) {
  const may = mayChange(role),
    mayAdd = may || role === 'director';
  const client = useQueryClient();
  const query = useQuery(cohortQuery(id));
  const [name, setName] = useState('');
  const [last, setLast] = useState<Person | null>(null);
  const store = async (cohort: Cohort) => {
    client.setQueryData(cohortQuery(id).queryKey, cohort);
    await client.invalidateQueries({ queryKey: cohortsQuery.queryKey, exact: true });
  };
  const added = useMutation({
    mutationFn: (person: string) => addToCohort(id, person),
    onSuccess: async (cohort) => {
      setName('');
      setLast(null);
      await store(cohort);
    },
  });
  const removed = useMutation({
    mutationFn: (person: Person) => removeFromCohort(id, person.account_id),
    onSuccess: async (cohort, person) => {
      setLast(person);
      await store(cohort);
    },
  });
  const invited = useMutation({
    mutationFn: (person: string) => inviteIntoCohort(id, person),
    onSuccess: async (cohort) => {
      setName('');
      added.reset();
      await store(cohort);
    },
  });
  const failed = invited.error ?? removed.error;
  if (query.isError)
    return (
      <Notice tone="bad" title={say('The cohort could not be loaded.')} onRetry={() => void query.refetch()}>
        {query.error.message}
      </Notice>
    );
  if (!query.data)
    return (
      <Card title={say('People')}>
        <Skeleton height="200px" />
      </Card>
    );
  const submit = (event: FormEvent) => {
    event.preventDefault();
    added.mutate(name.trim());
  };
  return (
    <Card title={query.data.name}>
      <div className={styles.stack}>
        {mayAdd ? (
          <form className={styles.form} onSubmit={submit}>
            <Field
              label={say('Account name')}
              value={name}
              required
              maxLength={100}
              onChange={(event) => setName(event.target.value)}
            />
            <Button type="submit" disabled={added.isPending || name.trim() === ''}>
              {say('Add to cohort')}
            </Button>
            <Button
              look="quiet"
              disabled={invited.isPending || name.trim() === ''}
              onClick={() => invited.mutate(name.trim())}
            >
              {say('Invite instead')}
            </Button>
          </form>
        ) : null}
        {added.isError ? (
          <Notice tone="bad" title={say('The person was not added.')}>
            {added.error.message}. {say('To add people whom you do not teach yet, invite them.')}
          </Notice>
        ) : null}
        {failed ? (
          <Notice tone="bad" title={say('The action failed.')}>
            {failed.message}
          </Notice>
        ) : null}
        {last ? (
          <p role="status">
            {say('{name} was removed.', { name: last.name })}{' '}
            {role === 'admin' ? (
              <Button look="quiet" onClick={() => added.mutate(last.name)}>
                {say('Undo')}
              </Button>
            ) : null}
          </p>
        ) : null}
        <DataTable<Person>
          caption={say('People of the cohort')}
          rows={query.data.people}
          keyOf={({ account_id }) => account_id}
          empty={say('No members yet.')}
          filter={{ label: say('Filter by name'), text: (one) => one.name }}
          columns={[
            { name: marked('Name'), by: (one) => one.name, cell: (one) => one.name },
            {
              name: marked('Role'),
              by: (one) => one.part,
              cell: (one) =>
                one.part === 'faculty' ? <Badge tone="accent">{roleName(one.part)}</Badge> : roleName(one.part),
            },
            { name: marked('State'), by: (one) => one.state, cell: (one) => say(one.state) },
            {
              name: <span className="hidden-visually">{say('Actions')}</span>,
              cell: (one) =>
                may ? (
                  <span className={styles.buttons}>
                    <Button
                      look="quiet"
                      label={say('Remove: {name}', { name: one.name })}
                      disabled={removed.isPending}
                      onClick={() => removed.mutate(one)}
                    >
                      {say('Remove')}
                    </Button>
                  </span>
                ) : null,
            },
          ]}
        />
        {mayAdd ? <InvitedPeople cohort={query.data} onChange={store} /> : null}
      </div>
    </Card>
  );
}

/** Cohorts and their members. */
export function CohortsPage() {
  const query = useQuery(cohortsQuery);
  const role = useQuery({ ...sessionQuery, enabled: false }).data?.role;
  const may = mayChange(role);
  const chosen = new URLSearchParams(useSearch()).get('id') ?? query.data?.cohorts[0]?.id;
  return (
    <Frame
      at="cohorts"
      lead={say(
        'Groups of trainees and the faculty who lead them. Faculty see the trials of the people in their cohorts.',
      )}
    >
      {query.isError ? (
        <Notice tone="bad" title={say('The cohorts could not be loaded.')} onRetry={() => void query.refetch()}>
          {query.error.message}
        </Notice>
      ) : null}
      <div className={styles.two}>
        <Card title={say('Cohorts')}>
          <div className={styles.stack}>
            <DataTable<CohortSummary>
              caption={say('Cohorts')}
              rows={query.data?.cohorts}
              keyOf={({ id }) => id}
              empty={say('No cohorts yet.')}
              columns={[
                {
                  name: marked('Cohort'),
                  by: (one) => one.name,
                  cell: (one) => (
                    <Link href={`/network/cohorts?id=${one.id}`} aria-current={one.id === chosen ? 'true' : undefined}>
                      {one.name}
                    </Link>
                  ),
                },
                {
                  name: marked('Trainees'),
                  by: (one) => one.trainees,
                  cell: (one) => formatCount(one.trainees),
                  number: true,
                },
                {
                  name: marked('Created'),
                  by: (one) => one.made_utc_us,
                  cell: (one) => formatDateTime(one.made_utc_us),
                },
              ]}
            />
            {may ? <NewCohortForm /> : null}
          </div>
        </Card>
        {chosen ? <Members key={chosen} id={chosen} role={role} /> : null}
      </div>
    </Frame>
  );
}
