import { useMutation, useQuery, useQueryClient } from '@tanstack/react-query';
import { assignmentQuery, referencesQuery, setReference, setRelease, type References, type Trial } from '@/api';
import { say } from '@/language';
import { Button, Notice, Select } from '@/ui';
import { formatDateTime, formatDuration } from '@/units';
import styles from './debrief.module.css';

export interface Choice {
  readonly id: string;
  readonly by: 'progress' | 'time';
}

const nameOf = (one: References['trials'][number]) =>
  `${one.operator || say('an expert')}${one.simulated ? `, ${say('simulated')}` : ''}, ${formatDateTime(one.started_utc_us)}, ${formatDuration(one.duration_s)}`;

/** The example trial that is replayed as a ghost, and how its time is aligned. */
export function ExampleField({
  trial,
  choice,
  may,
  onChoice,
}: {
  readonly trial: string;
  readonly choice: Choice;
  readonly may: boolean;
  readonly onChoice: (choice: Choice) => void;
}) {
  const client = useQueryClient();
  const query = useQuery(referencesQuery(trial));
  const offered = useMutation({
    mutationFn: (reference: boolean) => setReference(trial, reference),
    onSuccess: (all) => {
      client.setQueryData(referencesQuery(trial).queryKey, all);
    },
  });
  if (query.isError)
    return (
      <Notice tone="warn" title={say('Examples could not be loaded.')} onRetry={() => void query.refetch()}>
        {query.error.message}
      </Notice>
    );
  const trials = query.data?.trials ?? [];
  const options = [
    { value: '', text: trials.length === 0 ? say('none available for this case') : say('none') },
    ...trials.map((one) => ({ value: one.id, text: nameOf(one) })),
  ];
  return (
    <div className={styles.example}>
      <Select
        label={say('Example trial')}
        value={choice.id}
        disabled={trials.length === 0}
        options={options}
        onChange={(event) => onChoice({ ...choice, id: event.target.value })}
      />
      <Select
        label={say('Align by')}
        value={choice.by}
        disabled={choice.id === ''}
        options={[
          { value: 'progress', text: say('progress along the tract') },
          { value: 'time', text: say('time') },
        ]}
        onChange={(event) => onChoice({ ...choice, by: event.target.value === 'time' ? 'time' : 'progress' })}
      />
      {may && query.data ? (
        <Button
          pressed={query.data.reference}
          disabled={offered.isPending}
          onClick={() => offered.mutate(!query.data.reference)}
        >
          {query.data.reference ? say('Shared as an example') : say('Share as an example')}
        </Button>
      ) : null}
      {offered.isError ? (
        <Notice tone="bad" title={say('The action failed.')}>
          {offered.error.message}
        </Notice>
      ) : null}
    </div>
  );
}

/** Releases or hides the results of the trial's assignment. */
export function ReleaseField({ trial, may }: { readonly trial: Trial; readonly may: boolean }) {
  const client = useQueryClient();
  const id = trial.study?.id ?? '';
  const assigned = may && id.startsWith('a-');
  const query = useQuery({ ...assignmentQuery(id), enabled: assigned });
  const set = useMutation({
    mutationFn: (released: boolean) => setRelease(id, released ? 'released' : 'held'),
    onSuccess: (next) => {
      client.setQueryData(assignmentQuery(id).queryKey, next);
    },
  });
  if (!assigned || !query.data) return null;
  const held = query.data.release === 'held';
  return (
    <p className={styles.release} data-part="release">
      <span>
        {held
          ? say('Trainees cannot see the results of this assignment yet.')
          : say('Trainees can see the results and comments of this assignment.')}
      </span>
      <Button look={held ? 'solid' : 'plain'} disabled={set.isPending} onClick={() => set.mutate(held)}>
        {held ? say('Release results') : say('Hide results')}
      </Button>
      {set.isError ? <span role="alert">{set.error.message}</span> : null}
    </p>
  );
}
