import { useMutation, useQuery, useQueryClient } from '@tanstack/react-query';
import { useState, type FormEvent } from 'react';
import { Link } from 'wouter';
import { assignmentQuery, assignmentsQuery, assignPerson, freePerson, markAssignedInvalid, sessionQuery, setDue, setRelease, type Assignment, type Release } from '@/api';
import { AskDialog, Button, Card, Facts, Field, Notice, ReasonDialog, Skeleton, Table, useTitle } from '@/ui';
import { formatDateTime } from '@/units';
import styles from './assignments.module.css';
import { fromField, toField } from './dates';
import { Done, Drilling, DueDate } from './parts';
import { TrialsTable } from './trials-table';
import { kOrderWords, kReleaseWords } from './words';

type Keep = (next: Assignment) => Promise<void>;

function useKeep(id: string): Keep {
  const client = useQueryClient();
  return async (next) => {
    client.setQueryData(assignmentQuery(id).queryKey, next);
    await client.invalidateQueries({ queryKey: assignmentsQuery.queryKey, exact: true });
  };
}

/** Results held or released; what was can be brought back at once. */
function Results({ one, keep }: { readonly one: Assignment; readonly keep: Keep }) {
  const [before, setBefore] = useState<Release | null>(null);
  const set = useMutation({ mutationFn: (to: Release) => setRelease(one.id, to), onSuccess: keep });
  const go = (to: Release, from: Release | null) => { setBefore(from); set.mutate(to); };
  return (
    <Card title="Results">
      <div className={styles.stack} data-part="results">
        <p><strong>{kReleaseWords[one.release].name}</strong>. {kReleaseWords[one.release].means}</p>
        <div className={styles.buttons}>
          {one.release === 'released' ? <Button onClick={() => go('held', 'released')} disabled={set.isPending}>Hold them</Button> : <Button look="solid" onClick={() => go('released', one.release)} disabled={set.isPending}>Release results</Button>}
          {before !== null && !set.isPending && set.isSuccess ? <Button look="quiet" onClick={() => go(before, null)}>Undo</Button> : null}
        </div>
        {set.isError ? <Notice tone="bad" title="That was not done.">{set.error.message}</Notice> : null}
      </div>
    </Card>
  );
}

function DueDialog({ one, keep, onClose }: { readonly one: Assignment; readonly keep: Keep; readonly onClose: () => void }) {
  const [text, setText] = useState(toField(one.due_utc_us));
  return (
    <AskDialog title="When is it due?" deed="Set" ready={text === '' || fromField(text) !== null} onClose={onClose} onDeed={() => setDue(one.id, fromField(text)).then(keep)}>
      <p>Stations hand out what is due first. An empty date takes it away.</p>
      <Field label="Due" type="datetime-local" value={text} onChange={(event) => setText(event.target.value)} />
    </AskDialog>
  );
}

type Trainee = Assignment['trainees'][number];

function Trainees({ one, keep, may }: { readonly one: Assignment; readonly keep: Keep; readonly may: boolean }) {
  const [name, setName] = useState('');
  const [freeing, setFreeing] = useState<Trainee | null>(null);
  const added = useMutation({ mutationFn: (person: string) => assignPerson(one.id, person), onSuccess: async (next) => { setName(''); await keep(next); } });
  const submit = (event: FormEvent) => { event.preventDefault(); added.mutate(name.trim()); };
  return (
    <Card title="Trainees">
      <div className={styles.stack}>
        <Table<Trainee> caption="Trainees" rows={one.trainees} keyOf={({ account_id }) => account_id} empty="It is assigned to nobody yet." columns={[
          { name: 'Name', cell: (person) => <Link href={`/trainees/${encodeURIComponent(person.participant)}`}>{person.name}</Link> },
          { name: 'Done', cell: (person) => <Done done={person.done} planned={person.planned} label={`Trials done by ${person.name}`} /> },
          { name: <span className="hidden-visually">Decide</span>, cell: (person) => (may && person.done < person.planned ? <Button look="quiet" label={`Free what a station holds: ${person.name}`} onClick={() => setFreeing(person)}>Free…</Button> : null) },
        ]} />
        {may ? (
          <form className={styles.add} onSubmit={submit}>
            <Field label="One more trainee, by name" value={name} maxLength={100} onChange={(event) => setName(event.target.value)} />
            <Button type="submit" disabled={name.trim() === '' || added.isPending}>Assign to them</Button>
          </form>
        ) : null}
        {added.isError ? <Notice tone="bad" title="That was not done.">{added.error.message}</Notice> : null}
      </div>
      {freeing ? (
        <AskDialog title={`Free what a station holds of ${freeing.name}?`} deed="Free it" onClose={() => setFreeing(null)} onDeed={() => freePerson(one.id, freeing.account_id).then(keep)}>
          <p>A station that has begun a trial keeps it until it hands it over. Freed, the trial waits again and any station may hand it out; should the first one arrive after all, it stays as surplus.{one.to_drill > 0 ? ' A channel that was drilled there and not felt yet is drilled anew.' : ''}</p>
        </AskDialog>
      ) : null}
    </Card>
  );
}

function Teaching({ one, may }: { readonly one: Assignment; readonly may: boolean }) {
  const keep = useKeep(one.id);
  const [dialog, setDialog] = useState<'due' | string | null>(null);
  return (
    <>
      <div className={styles.two}>
        <Trainees one={one} keep={keep} may={may} />
        <div className={styles.stack}>
          {may ? <Results one={one} keep={keep} /> : null}
          <Card title="How">
            <div className={styles.stack}>
              <Facts facts={[
                { name: 'Order', value: one.ordering ? kOrderWords[one.ordering] : '–' }, { name: 'Times each case', value: String(one.repeats ?? 1) },
                { name: 'Cohort', value: one.cohort_name || 'none' }, { name: 'Made', value: `${formatDateTime(one.made_utc_us)} by ${one.made_by}` },
              ]} />
              {may ? <div className={styles.buttons}><Button onClick={() => setDialog('due')}>Change the date…</Button></div> : null}
            </div>
          </Card>
        </div>
      </div>
      <Card title="Trials"><TrialsTable one={one} may={may} onInvalid={setDialog} /></Card>
      {dialog === 'due' ? <DueDialog one={one} keep={keep} onClose={() => setDialog(null)} /> : null}
      {dialog !== null && dialog !== 'due' ? (
        <ReasonDialog title="This trial does not count?" text="It stays, with the reason, and is repeated as the assignment says." deed="Mark it invalid" reasonNeeded
          onDeed={(reason) => markAssignedInvalid(one.id, dialog, reason).then(keep)} onClose={() => setDialog(null)} />
      ) : null}
    </>
  );
}

function Own({ one }: { readonly one: Assignment }) {
  return (
    <>
      {one.to_drill > 0 ? <p>Where the bone is whole you drill the channel first, and then feel the one that you made: two trials at the same station. It is done when both are in.</p> : null}
      <Card title="Results">
        {one.release === 'held'
          ? <p data-part="held">Your results are shown here once they are released. Until then the cases stay blind for all.</p>
          : <TrialsTable one={one} may={false} own />}
      </Card>
    </>
  );
}

/** One assignment: who has done what, when it is due, and whether the results may be seen. */
export function AssignmentPage({ id }: { readonly id: string }) {
  const query = useQuery(assignmentQuery(id));
  const role = useQuery({ ...sessionQuery, enabled: false }).data?.role;
  const [now_us] = useState(() => Date.now() * 1000);
  const one = query.data;
  useTitle(one?.title ?? 'Assignment');
  return (
    <div className={styles.page}>
      <p><Link href="/assignments">← {role === 'trainee' ? 'My work' : 'Assignments'}</Link></p>
      {query.isError && !one ? <Notice tone="bad" title="The assignment could not be loaded." onRetry={() => void query.refetch()}>{query.error.message}</Notice> : null}
      {query.isPending ? <div role="status"><span className="hidden-visually">Loading the assignment</span><Skeleton height="480px" /></div> : null}
      {one ? (
        <>
          <div className={styles.headline}><h1>{one.title}</h1><DueDate one={one} now_us={now_us} /><Done done={one.done} planned={one.planned} label="Trials done in all" /><Drilling one={one} /></div>
          {role === 'trainee' ? <Own one={one} /> : <Teaching one={one} may={role === 'admin' || role === 'faculty'} />}
        </>
      ) : null}
    </div>
  );
}
