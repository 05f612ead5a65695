import { useMutation, useQuery, useQueryClient } from '@tanstack/react-query';
import { useId, useState, useSyncExternalStore, type FormEvent } from 'react';
import { addComment, commentsQuery, removeComment, type TrialComment } from '@/api';
import type { Cursor } from '@/charts';
import { say } from '@/language';
import { Button, Notice, Skeleton } from '@/ui';
import { formatDateTime, formatTime, second } from '@/units';
import styles from './debrief.module.css';
import type { Player } from './use-player';

function CursorTime({ cursor }: { readonly cursor: Cursor }) {
  const now = useSyncExternalStore(cursor.subscribe, cursor.now) ?? 0;
  return <>{say('at the current time, {now}', { now: formatTime(second(now), 1) })}</>;
}

function CommentForm({
  trial,
  cursor,
  onAdded,
}: {
  readonly trial: string;
  readonly cursor: Cursor;
  readonly onAdded: () => void;
}) {
  const [text, setText] = useState('');
  const [moment, setMoment] = useState(true);
  const client = useQueryClient();
  const id = useId();
  const added = useMutation({
    mutationFn: () => addComment(trial, moment ? Math.round((cursor.now() ?? 0) * 100) / 100 : null, text.trim()),
    onSuccess: (all) => {
      client.setQueryData(commentsQuery(trial).queryKey, all);
      void client.invalidateQueries({ queryKey: ['assignments'] });
      setText('');
      onAdded();
    },
  });
  const submit = (event: FormEvent) => {
    event.preventDefault();
    added.mutate();
  };
  return (
    <form className={styles.say} onSubmit={submit}>
      <label htmlFor={id}>{say('Comment')}</label>
      <textarea id={id} rows={3} maxLength={4000} value={text} onChange={(event) => setText(event.target.value)} />
      <label className={styles.check}>
        <input type="checkbox" checked={moment} onChange={(event) => setMoment(event.target.checked)} />{' '}
        <CursorTime cursor={cursor} />
      </label>
      <Button look="solid" type="submit" disabled={text.trim() === '' || added.isPending}>
        {added.isPending ? say('Saving…') : say('Add comment')}
      </Button>
      {added.isError ? (
        <Notice tone="bad" title={say('The comment was not saved.')}>
          {added.error.message}
        </Notice>
      ) : null}
    </form>
  );
}

/** Comments on the trial; the time of a comment is a link to it. */
export function Comments({
  trial,
  cursor,
  player,
  may,
}: {
  readonly trial: string;
  readonly cursor: Cursor;
  readonly player: Player;
  readonly may: boolean;
}) {
  const query = useQuery(commentsQuery(trial));
  const client = useQueryClient();
  const [gone, setGone] = useState<TrialComment | null>(null);
  const store = (all: { comments: TrialComment[] }) => {
    client.setQueryData(commentsQuery(trial).queryKey, all);
  };
  const removed = useMutation({
    mutationFn: (one: TrialComment) => removeComment(trial, one.id),
    onSuccess: (all, one) => {
      store(all);
      setGone(one);
    },
  });
  const back = useMutation({
    mutationFn: (one: TrialComment) => addComment(trial, one.at_s, one.text),
    onSuccess: (all) => {
      store(all);
      setGone(null);
    },
  });
  if (query.isError)
    return (
      <Notice tone="bad" title={say('The comments could not be loaded.')} onRetry={() => void query.refetch()}>
        {query.error.message}
      </Notice>
    );
  if (!query.data) return <Skeleton height="160px" />;
  const { comments } = query.data;
  return (
    <div className={styles.stack}>
      {comments.length === 0 ? (
        <p className={styles.muted}>{say('No comments yet.')}</p>
      ) : (
        <ul className={styles.comments} data-part="comments">
          {comments.map((one) => (
            <li key={one.id}>
              <p className={styles.said}>{one.text}</p>
              <p className={styles.by}>
                {one.at_s === null ? (
                  <span>{say('whole trial')}</span>
                ) : (
                  <button type="button" className={styles.jump} onClick={() => player.seek(one.at_s ?? 0)}>
                    {formatTime(one.at_s, 1)}
                  </button>
                )}
                <span>
                  {one.by}, {formatDateTime(one.made_utc_us)}
                </span>
                {one.own ? (
                  <Button
                    look="quiet"
                    label={say('Delete: {text}', { text: one.text.slice(0, 40) })}
                    disabled={removed.isPending}
                    onClick={() => removed.mutate(one)}
                  >
                    {say('Delete')}
                  </Button>
                ) : null}
              </p>
            </li>
          ))}
        </ul>
      )}
      {gone ? (
        <p role="status">
          {say('Comment deleted.')}{' '}
          <Button look="quiet" onClick={() => back.mutate(gone)} disabled={back.isPending}>
            {say('Undo')}
          </Button>
        </p>
      ) : null}
      {removed.isError || back.isError ? (
        <Notice tone="bad" title={say('The action failed.')}>
          {(removed.error ?? back.error)?.message}
        </Notice>
      ) : null}
      {may ? <CommentForm trial={trial} cursor={cursor} onAdded={() => setGone(null)} /> : null}
    </div>
  );
}
