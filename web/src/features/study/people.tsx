import { useState } from 'react';
import { Link } from 'wouter';
import type { Participant, Slot, Study } from '@/api';
import { Badge, Button } from '@/ui';
import { formatCount, kNone } from '@/units';
import type { StudyAction } from './action-dialog';
import { ParticipantTrials } from './participant-trials';
import styles from './people.module.css';
import { statusOf, kMarkSign, kMarkLabel, levelOf, markOf, progressOf, trialOf } from './labels';

interface Props {
  readonly study: Study;
  readonly ask: (action: StudyAction) => void;
}

const kColumns = ['Participant', 'Status', 'Trials in order', 'Done', 'Recognised', ''] as const;

function Cell({ slot }: { readonly slot: Slot }) {
  const mark = markOf(slot),
    trial = trialOf(slot);
  const label = `${formatCount(slot.number)}: ${kMarkLabel[mark]}`;
  const arrived = trial && trial.state !== 'arriving';
  return (
    <li data-mark={mark} className={styles.cell}>
      {arrived ? (
        <Link href={`/trials/${encodeURIComponent(trial.id)}`} title={label} aria-label={`Trial ${label}`}>
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

interface RowProps {
  readonly participant: Participant;
  readonly open: boolean;
  readonly toggle: () => void;
  readonly ask: (action: StudyAction) => void;
}

function Row({ participant, open, toggle, ask }: RowProps) {
  const status = statusOf(participant);
  const { name } = participant;
  return (
    <>
      <tr data-participant={name}>
        <th scope="row">
          <button type="button" className={styles.name} aria-expanded={open} onClick={toggle}>
            <span aria-hidden="true">{open ? '▾' : '▸'}</span> {name}
          </button>
          <span className={styles.level}>
            {levelOf(participant)}
            {participant.simulated ? (
              <>
                {' '}
                <Badge tone="warn">simulated</Badge>
              </>
            ) : null}
          </span>
        </th>
        <td>
          <Badge tone={status.tone}>{status.text}</Badge>
          <span className={styles.level}>{participant.last_station ?? ''}</span>
        </td>
        <td>
          <ol className={styles.cells}>
            {participant.slots.map((slot) => (
              <Cell key={slot.number} slot={slot} />
            ))}
          </ol>
        </td>
        <td className={styles.number} data-part="done">
          {progressOf(participant)}
        </td>
        <td className={styles.number} data-part="recognised">
          {participant.judged === 0
            ? kNone
            : `${formatCount(participant.recognised)} of ${formatCount(participant.judged)}`}
        </td>
        <td className={styles.actions}>
          {participant.state === 'paused' ? (
            <Button label={`Resume ${name}`} onClick={() => ask({ kind: 'resume', participant: name })}>
              Resume
            </Button>
          ) : (
            <Button
              label={`Pause ${name}`}
              disabled={status.text === 'complete'}
              onClick={() => ask({ kind: 'pause', participant: name })}
            >
              Pause
            </Button>
          )}
        </td>
      </tr>
      {open ? (
        <tr>
          <td colSpan={kColumns.length} className={styles.inside}>
            <ParticipantTrials participant={participant} ask={ask} />
          </td>
        </tr>
      ) : null}
    </>
  );
}

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
      <div className={styles.frame}>
        <table className={styles.table}>
          <caption className="hidden-visually">Participants and their trials</caption>
          <thead>
            <tr>
              {kColumns.map((column) => (
                <th
                  key={column}
                  scope="col"
                  className={column === 'Done' || column === 'Recognised' ? styles.number : undefined}
                >
                  {column === '' ? <span className="hidden-visually">Actions</span> : column}
                </th>
              ))}
            </tr>
          </thead>
          <tbody>
            {study.participants.map((one) => (
              <Row
                key={one.name}
                participant={one}
                open={opened.has(one.name)}
                toggle={() => toggle(one.name)}
                ask={ask}
              />
            ))}
          </tbody>
        </table>
      </div>
      <ul className={styles.key} aria-label="Legend">
        {(Object.keys(kMarkLabel) as (keyof typeof kMarkLabel)[]).map((mark) => (
          <li key={mark}>
            <span data-mark={mark} className={styles.cell} aria-hidden="true">
              <span>{kMarkSign[mark]}</span>
            </span>
            {kMarkLabel[mark]}
          </li>
        ))}
      </ul>
    </>
  );
}
