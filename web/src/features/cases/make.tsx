import { useMutation, useQueryClient } from '@tanstack/react-query';
import { useState, type FormEvent } from 'react';
import { useLocation } from 'wouter';
import { makeCase, makingsQuery, type NewCase } from '@/api';
import { say } from '@/language';
import { Button, Field, Notice } from '@/ui';
import styles from './cases.module.css';
import { caseOf, fiveOf, requestOf, type Plan } from './plan';

/** Gives the planned case a title and asks the server to make it, or five of it. */
export function Make({
  volume,
  plan,
  ready,
}: {
  readonly volume: string;
  readonly plan: Plan;
  readonly ready: boolean;
}) {
  const client = useQueryClient();
  const [, go] = useLocation();
  const [title, setTitle] = useState('');
  const request = requestOf(plan);
  const made = useMutation({
    mutationFn: (wanted: readonly NewCase[]) => Promise.all(wanted.map(makeCase)),
    onSuccess: async () => {
      await client.invalidateQueries({ queryKey: makingsQuery.queryKey });
      go('/cases');
    },
  });
  const submit = (event: FormEvent) => {
    event.preventDefault();
    if (request) made.mutate([caseOf(request, volume, title.trim())]);
  };
  return (
    <form className={styles.make} onSubmit={submit}>
      <Field
        label={say('Title (not shown to trainees)')}
        value={title}
        required
        maxLength={200}
        placeholder={say('L3 left, medial breach')}
        onChange={(event) => setTitle(event.target.value)}
      />
      <Button look="solid" type="submit" disabled={!ready || request === null || title.trim() === '' || made.isPending}>
        {made.isPending ? say('Submitting…') : say('Create case')}
      </Button>
      {plan.whole || plan.preparation !== 'filled' ? null : (
        <Button
          disabled={!ready || request === null || title.trim() === '' || made.isPending}
          onClick={() => request && made.mutate(fiveOf(request, volume, title.trim()))}
        >
          {say('Create five, one a wall, equally hard')}
        </Button>
      )}
      <p className={styles.muted}>{say('Trainees see the blind name from the assignment instead of this title.')}</p>
      {made.isError ? (
        <Notice tone="bad" title={say('The case was not created.')}>
          {made.error.message}
        </Notice>
      ) : null}
    </form>
  );
}
