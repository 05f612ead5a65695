import { useMutation, useQuery, useQueryClient } from '@tanstack/react-query';
import { assignmentQuery, referencesQuery, setReference, setRelease, type References, type Trial } from '@/api';
import { Button, Notice, Select } from '@/ui';
import { formatDateTime, formatDuration } from '@/units';
import styles from './debrief.module.css';

export interface Choice { readonly id: string; readonly by: 'progress' | 'time' }

const nameOf = (one: References['trials'][number]) =>
  `${one.operator || 'an expert'}${one.simulated ? ', simulated' : ''}, ${formatDateTime(one.started_utc_us)}, ${formatDuration(one.duration_s)}`;

/** Whose trial goes along as a ghost, and how their times are put together. */
export function ExampleField({ trial, choice, may, onChoice }: { readonly trial: string; readonly choice: Choice; readonly may: boolean; readonly onChoice: (choice: Choice) => void }) {
  const client = useQueryClient();
  const query = useQuery(referencesQuery(trial));
  const offered = useMutation({ mutationFn: (reference: boolean) => setReference(trial, reference), onSuccess: (all) => { client.setQueryData(referencesQuery(trial).queryKey, all); } });
  if (query.isError) return <Notice tone="warn" title="Examples could not be loaded." onRetry={() => void query.refetch()}>{query.error.message}</Notice>;
  const trials = query.data?.trials ?? [];
  const options = [{ value: '', text: trials.length === 0 ? 'none is offered on this case' : 'none' }, ...trials.map((one) => ({ value: one.id, text: nameOf(one) }))];
  return (
    <div className={styles.example}>
      <Select label="Example beside it" value={choice.id} disabled={trials.length === 0} options={options} onChange={(event) => onChoice({ ...choice, id: event.target.value })} />
      <Select label="Together by" value={choice.by} disabled={choice.id === ''} options={[{ value: 'progress', text: 'progress along the tract' }, { value: 'time', text: 'the clock' }]}
        onChange={(event) => onChoice({ ...choice, by: event.target.value === 'time' ? 'time' : 'progress' })} />
      {may && query.data ? (
        <Button pressed={query.data.reference} disabled={offered.isPending} onClick={() => offered.mutate(!query.data.reference)}>{query.data.reference ? 'Offered as an example' : 'Offer as an example'}</Button>
      ) : null}
      {offered.isError ? <Notice tone="bad" title="That was not done.">{offered.error.message}</Notice> : null}
    </div>
  );
}

/** Results of the assignment that the trial is of: held, or to be seen by its trainees. */
export function ReleaseField({ trial, may }: { readonly trial: Trial; readonly may: boolean }) {
  const client = useQueryClient();
  const id = trial.study?.id ?? '';
  const assigned = may && id.startsWith('a-');
  const query = useQuery({ ...assignmentQuery(id), enabled: assigned });
  const set = useMutation({ mutationFn: (released: boolean) => setRelease(id, released ? 'released' : 'held'), onSuccess: (next) => { client.setQueryData(assignmentQuery(id).queryKey, next); } });
  if (!assigned || !query.data) return null;
  const held = query.data.release === 'held';
  return (
    <p className={styles.release} data-part="release">
      <span>{held ? 'Trainees of this assignment do not see its results yet.' : 'Trainees of this assignment see its results and comments.'}</span>
      <Button look={held ? 'solid' : 'plain'} disabled={set.isPending} onClick={() => set.mutate(held)}>{held ? 'Release results' : 'Hold them'}</Button>
      {set.isError ? <span role="alert">{set.error.message}</span> : null}
    </p>
  );
}
