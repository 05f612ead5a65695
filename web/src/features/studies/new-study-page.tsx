import { useMutation } from '@tanstack/react-query';
import { useState, type FormEvent } from 'react';
import { Link, useLocation } from 'wouter';
import { makeStudy } from '@/api';
import { say } from '@/language';
import { Button, Card, Field, Notice, useTitle } from '@/ui';
import { formatCount } from '@/units';
import { idOf, kBlank, participantsOf, studyOf, type Draft } from './draft';
import styles from './new-study.module.css';
import { Protocol, Scenarios } from './protocol-fields';

function People({ draft, set }: { readonly draft: Draft; readonly set: (changes: Partial<Draft>) => void }) {
  const { participants, faults } = participantsOf(draft.participants);
  return (
    <Card
      title={say('Participants')}
      aside={
        <span className={styles.count} role="status">
          {say('{count} valid', { count: formatCount(participants.length) })}
        </span>
      }
    >
      <div className={styles.people}>
        <label htmlFor="participants">{say('One per line: pseudonym, level, years of experience')}</label>
        <textarea
          id="participants"
          rows={8}
          spellCheck={false}
          value={draft.participants}
          placeholder={'P01, resident, 0.5\nP02, senior, 6'}
          aria-describedby="participants-hint"
          onChange={(event) => set({ participants: event.target.value })}
        />
        <p id="participants-hint" className={styles.hint}>
          {say(
            'Use pseudonyms only; the names are stored elsewhere. You can enrol more participants later. Add “simulated” to a line for a simulated surgeon.',
          )}
        </p>
        <ul className={styles.faults} aria-live="polite">
          {faults.map((fault) => (
            <li key={fault}>{fault}</li>
          ))}
        </ul>
      </div>
    </Card>
  );
}

/** Scenarios, repeats, order and participants of a new study. */
export function NewStudyPage() {
  useTitle(say('New study'));
  const [draft, setDraft] = useState<Draft>(kBlank);
  const [, go] = useLocation();
  const set = (changes: Partial<Draft>) => setDraft((before) => ({ ...before, ...changes }));
  const made = useMutation({ mutationFn: makeStudy, onSuccess: ({ id }) => go(`/studies/${encodeURIComponent(id)}`) });
  const ready = studyOf(draft);
  const submit = (event: FormEvent) => {
    event.preventDefault();
    if ('study' in ready) made.mutate(ready.study);
  };
  const trials = 'study' in ready ? ready.study.scenarios.length * ready.study.repeats : null;
  return (
    <form className={styles.page} onSubmit={submit}>
      <p className={styles.back}>
        <Link href="/studies">← {say('Studies')}</Link>
      </p>
      <h1>{say('New study')}</h1>
      <Card title={say('Name')}>
        <div className={styles.names}>
          <Field
            label={say('Title')}
            value={draft.title}
            maxLength={200}
            required
            onChange={(event) => set({ title: event.target.value })}
          />
          <Field
            label={say('Short name for stations')}
            value={draft.id}
            maxLength={32}
            placeholder={idOf(draft.title) || 'spine-study-1'}
            pattern="[a-z0-9][a-z0-9\-]*"
            spellCheck={false}
            autoCapitalize="none"
            onChange={(event) => set({ id: event.target.value })}
          />
        </div>
      </Card>
      <Scenarios draft={draft} set={set} />
      <Protocol draft={draft} set={set} />
      <People draft={draft} set={set} />
      {made.isError ? (
        <Notice tone="bad" title={say('The study was not created.')}>
          {made.error.message}
        </Notice>
      ) : null}
      <div className={styles.end}>
        <p className={styles.hint} role="status">
          {trials === null
            ? 'faults' in ready
              ? ready.faults[0]
              : ''
            : say('{count} trials for each participant.', { count: formatCount(trials) })}
        </p>
        <Button look="solid" type="submit" disabled={!('study' in ready) || made.isPending}>
          {made.isPending ? say('Creating…') : say('Create study')}
        </Button>
      </div>
    </form>
  );
}
