import { useMutation, useQuery, useQueryClient } from '@tanstack/react-query';
import { useState, type FormEvent } from 'react';
import { Link } from 'wouter';
import {
  assignmentQuery,
  kAssignmentLists,
  assignPerson,
  releaseReservation,
  markAssignedInvalid,
  sessionQuery,
  setDue,
  setRelease,
  type Assignment,
  type Release,
} from '@/api';
import { say } from '@/language';
import { AskDialog, Button, Card, DataTable, Facts, Field, Notice, ReasonDialog, Skeleton, useTitle } from '@/ui';
import { formatDateTime, timeZone } from '@/units';
import styles from './assignments.module.css';
import { dueProblem, fromField, toField } from './dates';
import { Done, Drilling, DueDate } from './parts';
import { TrialsTable } from './trials-table';
import { kOrderLabels, kReleaseLabels } from './labels';

type Store = (next: Assignment) => Promise<void>;

function useStore(id: string): Store {
  const client = useQueryClient();
  return async (next) => {
    client.setQueryData(assignmentQuery(id).queryKey, next);
    await client.invalidateQueries({ queryKey: kAssignmentLists });
  };
}

/** Releases or hides the results; the last change can be undone. */
function Results({ one, store }: { readonly one: Assignment; readonly store: Store }) {
  const [before, setBefore] = useState<Release | null>(null);
  const set = useMutation({ mutationFn: (to: Release) => setRelease(one.id, to), onSuccess: store });
  const go = (to: Release, from: Release | null) => {
    setBefore(from);
    set.mutate(to);
  };
  return (
    <Card title={say('Results')}>
      <div className={styles.stack} data-part="results">
        <p>
          <strong>{kReleaseLabels[one.release].name}</strong>. {kReleaseLabels[one.release].description}
        </p>
        <div className={styles.buttons}>
          {one.release === 'released' ? (
            <Button onClick={() => go('held', 'released')} disabled={set.isPending}>
              {say('Hide results')}
            </Button>
          ) : (
            <Button look="solid" onClick={() => go('released', one.release)} disabled={set.isPending}>
              {say('Release results')}
            </Button>
          )}
          {before !== null && !set.isPending && set.isSuccess ? (
            <Button look="quiet" onClick={() => go(before, null)}>
              {say('Undo')}
            </Button>
          ) : null}
        </div>
        {set.isError ? (
          <Notice tone="bad" title={say('The action failed.')}>
            {set.error.message}
          </Notice>
        ) : null}
      </div>
    </Card>
  );
}

function DueDialog({
  one,
  store,
  onClose,
}: {
  readonly one: Assignment;
  readonly store: Store;
  readonly onClose: () => void;
}) {
  const [text, setText] = useState(toField(one.due_utc_us));
  const [now_us] = useState(() => Date.now() * 1000);
  const wrong = dueProblem(text, now_us);
  return (
    <AskDialog
      title={say('Change due date')}
      action={say('Save')}
      ready={wrong === ''}
      onClose={onClose}
      onAction={() => setDue(one.id, fromField(text)).then(store)}
    >
      <p>
        {say('Stations offer the assignment with the earliest due date first. Leave the field empty for no due date.')}
      </p>
      <Field
        label={say('Due ({zone})', { zone: timeZone() })}
        type="datetime-local"
        value={text}
        error={text === toField(one.due_utc_us) ? '' : wrong}
        onChange={(event) => setText(event.target.value)}
      />
    </AskDialog>
  );
}

type Trainee = Assignment['trainees'][number];

function Trainees({ one, store, may }: { readonly one: Assignment; readonly store: Store; readonly may: boolean }) {
  const [name, setName] = useState('');
  const [releasing, setReleasing] = useState<Trainee | null>(null);
  const added = useMutation({
    mutationFn: (person: string) => assignPerson(one.id, person),
    onSuccess: async (next) => {
      setName('');
      await store(next);
    },
  });
  const submit = (event: FormEvent) => {
    event.preventDefault();
    added.mutate(name.trim());
  };
  return (
    <Card title={say('Trainees')}>
      <div className={styles.stack}>
        <DataTable<Trainee>
          caption={say('Trainees')}
          rows={one.trainees}
          keyOf={({ account_id }) => account_id}
          empty={say('No trainees yet.')}
          columns={[
            {
              name: say('Name'),
              by: (person) => person.name,
              cell: (person) => <Link href={`/trainees/${encodeURIComponent(person.participant)}`}>{person.name}</Link>,
            },
            {
              name: say('Done'),
              by: (person) => person.done / person.planned,
              cell: (person) => (
                <Done
                  done={person.done}
                  planned={person.planned}
                  label={say('Trials done by {name}', { name: person.name })}
                />
              ),
            },
            {
              name: <span className="hidden-visually">{say('Actions')}</span>,
              cell: (person) =>
                may && person.done < person.planned ? (
                  <Button
                    look="quiet"
                    label={say('Release reservation: {name}', { name: person.name })}
                    onClick={() => setReleasing(person)}
                  >
                    {say('Release reservation…')}
                  </Button>
                ) : null,
            },
          ]}
        />
        {may ? (
          <form className={styles.add} onSubmit={submit}>
            <Field
              label={say('Add a trainee by account name')}
              value={name}
              maxLength={100}
              onChange={(event) => setName(event.target.value)}
            />
            <Button type="submit" disabled={name.trim() === '' || added.isPending}>
              {say('Add trainee')}
            </Button>
          </form>
        ) : null}
        {added.isError ? (
          <Notice tone="bad" title={say('The action failed.')}>
            {added.error.message}
          </Notice>
        ) : null}
      </div>
      {releasing ? (
        <AskDialog
          title={say('Release the reservation for {name}?', { name: releasing.name })}
          action={say('Release reservation')}
          onClose={() => setReleasing(null)}
          onAction={() => releaseReservation(one.id, releasing.account_id).then(store)}
        >
          <p>
            {say(
              'A station reserves a trial from its start until the recording is uploaded. After the release, any station can offer the trial again. If the first station uploads its recording later, the recording is kept as surplus.',
            )}
            {one.to_drill > 0
              ? ` ${say('A channel that was drilled at that station and not yet palpated must be drilled again.')}`
              : ''}
          </p>
        </AskDialog>
      ) : null}
    </Card>
  );
}

function Teaching({ one, may }: { readonly one: Assignment; readonly may: boolean }) {
  const store = useStore(one.id);
  const [dialog, setDialog] = useState<'due' | string | null>(null);
  return (
    <>
      <div className={styles.two}>
        <Trainees one={one} store={store} may={may} />
        <div className={styles.stack}>
          {may ? <Results one={one} store={store} /> : null}
          <Card title={say('Settings')}>
            <div className={styles.stack}>
              <Facts
                facts={[
                  { name: say('Order'), value: one.ordering ? say(kOrderLabels[one.ordering]) : '–' },
                  { name: say('Repeats per case'), value: String(one.repeats ?? 1) },
                  { name: say('Cohort'), value: one.cohort_name || say('none') },
                  {
                    name: say('Created'),
                    value: say('{time} by {name}', { time: formatDateTime(one.made_utc_us), name: one.made_by }),
                  },
                ]}
              />
              {may ? (
                <div className={styles.buttons}>
                  <Button onClick={() => setDialog('due')}>{say('Change due date…')}</Button>
                </div>
              ) : null}
            </div>
          </Card>
        </div>
      </div>
      <Card title={say('Trials')}>
        <TrialsTable one={one} may={may} onInvalid={setDialog} />
      </Card>
      {dialog === 'due' ? <DueDialog one={one} store={store} onClose={() => setDialog(null)} /> : null}
      {dialog !== null && dialog !== 'due' ? (
        <ReasonDialog
          title={say('Mark this trial as invalid?')}
          text={say(
            'The trial is kept with your reason, but it is not counted. It is repeated as the assignment specifies.',
          )}
          action={say('Mark as invalid')}
          reasonNeeded
          onAction={(reason) => markAssignedInvalid(one.id, dialog, reason).then(store)}
          onClose={() => setDialog(null)}
        />
      ) : null}
    </>
  );
}

function Own({ one }: { readonly one: Assignment }) {
  return (
    <>
      {one.to_drill > 0 ? (
        <p>
          {say(
            'In cases without a pre-drilled channel, you first drill the channel and then palpate it: two trials at the same station. The case is done when both recordings are uploaded.',
          )}
        </p>
      ) : null}
      <Card title={say('Results')}>
        {one.release === 'held' ? (
          <p data-part="held">
            {say('Your results appear here after they are released. Until then, the cases stay blinded for everyone.')}
          </p>
        ) : (
          <TrialsTable one={one} may={false} own />
        )}
      </Card>
    </>
  );
}

/** One assignment: progress of each trainee, due date, release of results. */
export function AssignmentPage({ id }: { readonly id: string }) {
  const query = useQuery(assignmentQuery(id));
  const role = useQuery({ ...sessionQuery, enabled: false }).data?.role;
  const [now_us] = useState(() => Date.now() * 1000);
  const one = query.data;
  useTitle(one?.title ?? say('Assignment'));
  return (
    <div className={styles.page}>
      <p>
        <Link href="/assignments">← {role === 'trainee' ? say('My work') : say('Assignments')}</Link>
      </p>
      {query.isError && !one ? (
        <Notice tone="bad" title={say('The assignment could not be loaded.')} onRetry={() => void query.refetch()}>
          {query.error.message}
        </Notice>
      ) : null}
      {query.isPending ? (
        <div role="status">
          <span className="hidden-visually">{say('Loading the assignment')}</span>
          <Skeleton height="480px" />
        </div>
      ) : null}
      {one ? (
        <>
          <div className={styles.headline}>
            <h1>{one.title}</h1>
            <DueDate one={one} now_us={now_us} />
            <Done done={one.done} planned={one.planned} label={say('Trials done in total')} />
            <Drilling one={one} />
          </div>
          {role === 'trainee' ? <Own one={one} /> : <Teaching one={one} may={role === 'admin' || role === 'faculty'} />}
        </>
      ) : null}
    </div>
  );
}
