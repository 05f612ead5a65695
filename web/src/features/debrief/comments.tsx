import { useMutation, useQuery, useQueryClient } from '@tanstack/react-query';
import { useId, useState, useSyncExternalStore, type FormEvent } from 'react';
import { addComment, assignmentsQuery, commentsQuery, removeComment, type TrialComment } from '@/api';
import type { Cursor } from '@/charts';
import { Button, Notice, Skeleton } from '@/ui';
import { formatDateTime, formatTime, second } from '@/units';
import styles from './debrief.module.css';
import type { Player } from './use-player';

function At({ cursor }: { readonly cursor: Cursor }) {
  const now = useSyncExternalStore(cursor.subscribe, cursor.now) ?? 0;
  return <>at this moment, {formatTime(second(now), 1)}</>;
}

function Say({ trial, cursor, onSaid }: { readonly trial: string; readonly cursor: Cursor; readonly onSaid: () => void }) {
  const [text, setText] = useState('');
  const [moment, setMoment] = useState(true);
  const client = useQueryClient();
  const id = useId();
  const said = useMutation({
    mutationFn: () => addComment(trial, moment ? Math.round((cursor.now() ?? 0) * 100) / 100 : null, text.trim()),
    onSuccess: (all) => {
      client.setQueryData(commentsQuery(trial).queryKey, all);
      void client.invalidateQueries({ queryKey: assignmentsQuery.queryKey });
      setText('');
      onSaid();
    },
  });
  const submit = (event: FormEvent) => { event.preventDefault(); said.mutate(); };
  return (
    <form className={styles.say} onSubmit={submit}>
      <label htmlFor={id}>Comment</label>
      <textarea id={id} rows={3} maxLength={4000} value={text} onChange={(event) => setText(event.target.value)} />
      <label className={styles.check}><input type="checkbox" checked={moment} onChange={(event) => setMoment(event.target.checked)} /> <At cursor={cursor} /></label>
      <Button look="solid" type="submit" disabled={text.trim() === '' || said.isPending}>{said.isPending ? 'Saying…' : 'Comment'}</Button>
      {said.isError ? <Notice tone="bad" title="It was not kept.">{said.error.message}</Notice> : null}
    </form>
  );
}

/** What was said of the trial; a moment's comment leads there. */
export function Comments({ trial, cursor, player, may }: { readonly trial: string; readonly cursor: Cursor; readonly player: Player; readonly may: boolean }) {
  const query = useQuery(commentsQuery(trial));
  const client = useQueryClient();
  const [gone, setGone] = useState<TrialComment | null>(null);
  const keep = (all: { comments: TrialComment[] }) => { client.setQueryData(commentsQuery(trial).queryKey, all); };
  const removed = useMutation({ mutationFn: (one: TrialComment) => removeComment(trial, one.id), onSuccess: (all, one) => { keep(all); setGone(one); } });
  const back = useMutation({ mutationFn: (one: TrialComment) => addComment(trial, one.at_s, one.text), onSuccess: (all) => { keep(all); setGone(null); } });
  if (query.isError) return <Notice tone="bad" title="The comments could not be loaded." onRetry={() => void query.refetch()}>{query.error.message}</Notice>;
  if (!query.data) return <Skeleton height="160px" />;
  const { comments } = query.data;
  return (
    <div className={styles.stack}>
      {comments.length === 0 ? <p className={styles.muted}>Nothing was said yet.</p> : (
        <ul className={styles.comments} data-part="comments">
          {comments.map((one) => (
            <li key={one.id}>
              <p className={styles.said}>{one.text}</p>
              <p className={styles.by}>
                {one.at_s === null ? <span>the whole trial</span> : <button type="button" className={styles.jump} onClick={() => player.seek(one.at_s ?? 0)}>{formatTime(one.at_s, 1)}</button>}
                <span>{one.by}, {formatDateTime(one.made_utc_us)}</span>
                {one.own ? <Button look="quiet" label={`Take back: ${one.text.slice(0, 40)}`} disabled={removed.isPending} onClick={() => removed.mutate(one)}>Take back</Button> : null}
              </p>
            </li>
          ))}
        </ul>
      )}
      {gone ? <p role="status">Taken back. <Button look="quiet" onClick={() => back.mutate(gone)} disabled={back.isPending}>Undo</Button></p> : null}
      {removed.isError || back.isError ? <Notice tone="bad" title="That was not done.">{(removed.error ?? back.error)?.message}</Notice> : null}
      {may ? <Say trial={trial} cursor={cursor} onSaid={() => setGone(null)} /> : null}
    </div>
  );
}
