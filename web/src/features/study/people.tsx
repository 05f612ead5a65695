import { useState } from 'react';
import { Link } from 'wouter';
import type { Participant, Slot, Study } from '@/api';
import { marked, say } from '@/language';
import { Badge, Button, DataTable, type DataColumn } from '@/ui';
import { formatCount, kNone } from '@/units';
import type { StudyAction } from './action-dialog';
import { ParticipantTrials } from './participant-trials';
import styles from './people.module.css';
import { statusOf, kMarkSign, kMarkLabel, levelOf, markOf, progressOf, trialOf } from './labels';

interface Props {
  readonly study: Study;
  readonly ask: (action: StudyAction) => void;
}

function Cell({ slot }: { readonly slot: Slot }) {
  const mark = markOf(slot),
    trial = trialOf(slot);
  const label = say('{number}: {state}', { number: formatCount(slot.number), state: say(kMarkLabel[mark]) });
  const arrived = trial && trial.state !== 'arriving';
  return (
    <li data-mark={mark} className={styles.cell}>
      {arrived ? (
        <Link
          href={`/trials/${encodeURIComponent(trial.id)}`}
          title={label}
          aria-label={say('Trial {label}', { label })}
        >
          {kMarkSign[mark]}
        </Link>
      ) : (
        <span title={label}>
          <span aria-hidden="true">{kMarkSign[mark]}</span>
          <span className="hidden-visually">{label}</span>
        </span>
      )}
    </li>
  );
}

const columnsOf = (
  opened: ReadonlySet<string>,
  toggle: (name: string) => void,
  ask: Props['ask'],
): readonly DataColumn<Participant>[] => [
  {
    name: marked('Participant'),
    by: ({ name }) => name,
    cell: (one) => (
      <>
        <button
          type="button"
          className={styles.name}
          aria-expanded={opened.has(one.name)}
          onClick={() => toggle(one.name)}
        >
          <span aria-hidden="true">{opened.has(one.name) ? '▾' : '▸'}</span> {one.name}
        </button>
        <span className={styles.level}>
          {levelOf(one)}
          {one.simulated ? (
            <>
              {' '}
              <Badge tone="warn">{say('simulated')}</Badge>
            </>
          ) : null}
        </span>
      </>
    ),
  },
  {
    name: marked('Status'),
    by: (one) => say(statusOf(one).text),
    cell: (one) => (
      <>
        <Badge tone={statusOf(one).tone}>{say(statusOf(one).text)}</Badge>
        <span className={styles.level}>{one.last_station ?? ''}</span>
      </>
    ),
  },
  {
    name: marked('Trials in order'),
    cell: (one) => (
      <ol className={styles.cells}>
        {one.slots.map((slot) => (
          <Cell key={slot.number} slot={slot} />
        ))}
      </ol>
    ),
  },
  {
    name: marked('Done'),
    by: ({ done }) => done,
    cell: (one) => <span data-part="done">{progressOf(one)}</span>,
    number: true,
  },
  {
    name: marked('Recognised'),
    by: ({ judged, recognised }) => (judged === 0 ? null : recognised / judged),
    cell: ({ judged, recognised }) => (judged === 0 ? kNone : progressOf({ done: recognised, planned: judged })),
    number: true,
  },
  {
    name: <span className="hidden-visually">{say('Actions')}</span>,
    number: true,
    cell: (one) =>
      one.state === 'paused' ? (
        <Button
          label={say('Resume {name}', { name: one.name })}
          onClick={() => ask({ kind: 'resume', participant: one.name })}
        >
          {say('Resume')}
        </Button>
      ) : (
        <Button
          label={say('Pause {name}', { name: one.name })}
          disabled={statusOf(one).text === 'complete'}
          onClick={() => ask({ kind: 'pause', participant: one.name })}
        >
          {say('Pause')}
        </Button>
      ),
  },
];

/** A line per participant with a cell per trial; a press on the name shows the trials one by one. */
export function People({ study, ask }: Props) {
  const [opened, setOpened] = useState<ReadonlySet<string>>(new Set());
  const toggle = (name: string) =>
    setOpened((before) => {
      const next = new Set(before);
      if (!next.delete(name)) next.add(name);
      return next;
    });
  return (
    <>
      <DataTable<Participant>
        caption={say('Participants and their trials')}
        className={styles.frame}
        rows={study.participants}
        keyOf={({ name }) => name}
        empty={say('No participants yet.')}
        filter={{
          label: say('Filter by pseudonym, level or status'),
          text: (one) => `${one.name} ${levelOf(one)} ${say(statusOf(one).text)}`,
        }}
        columns={columnsOf(opened, toggle, ask)}
        detail={(one) => (opened.has(one.name) ? <ParticipantTrials participant={one} ask={ask} /> : null)}
      />
      <ul className={styles.key} aria-label={say('Legend')}>
        {(Object.keys(kMarkLabel) as (keyof typeof kMarkLabel)[]).map((mark) => (
          <li key={mark}>
            <span data-mark={mark} className={styles.cell} aria-hidden="true">
              <span>{kMarkSign[mark]}</span>
            </span>
            {say(kMarkLabel[mark])}
          </li>
        ))}
      </ul>
    </>
  );
}
