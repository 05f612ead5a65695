import { Link } from 'wouter';
import type { Participant, Slot, StudyTrial } from '@/api';
import { Badge, Button, type Tone } from '@/ui';
import { formatClock, formatCount, formatDuration, isoDateTime, kNone } from '@/units';
import type { StudyAction } from './action-dialog';
import styles from './participant-trials.module.css';

interface Props {
  readonly participant: Participant;
  readonly ask: (action: StudyAction) => void;
}

const kTrial: Record<StudyTrial['state'], { word: string; tone: Tone }> = {
  arriving: { word: 'uploading', tone: 'accent' },
  counts: { word: 'valid', tone: 'good' },
  invalid: { word: 'invalid', tone: 'warn' },
  surplus: { word: 'surplus', tone: 'warn' },
};
const kSlot: Record<Slot['state'], string> = {
  waiting: 'not started',
  taken: 'at a station',
  recorded: 'done',
  invalid: 'invalid',
};

function TrialCells({
  trial,
  slot,
  participant,
  ask,
}: {
  readonly trial: StudyTrial;
  readonly slot: Slot;
  readonly participant: string;
  readonly ask: (action: StudyAction) => void;
}) {
  const { word, tone } = kTrial[trial.state];
  const arrived = trial.started_utc_us !== null;
  return (
    <>
      <td>
        <Badge tone={tone}>{word}</Badge>
        {trial.reason === '' ? null : <span className={styles.reason}>{trial.reason}</span>}
      </td>
      <td>
        {trial.started_utc_us === null ? (
          kNone
        ) : (
          <time dateTime={isoDateTime(trial.started_utc_us)}>{formatClock(trial.started_utc_us)}</time>
        )}
      </td>
      <td>{trial.station}</td>
      <td className={styles.number}>{trial.duration_s === null ? kNone : formatDuration(trial.duration_s)}</td>
      <td className={styles.number}>{trial.samples === null ? kNone : formatCount(trial.samples)}</td>
      <td>{trial.correct === null ? kNone : trial.correct ? '✓ correct' : '✗ incorrect'}</td>
      <td className={styles.actions}>
        {arrived ? <Link href={`/trials/${encodeURIComponent(trial.id)}`}>Open</Link> : null}
        {trial.state === 'counts' ? (
          <Button
            look="quiet"
            label={`Mark as invalid: trial ${slot.number} of ${participant}`}
            onClick={() => ask({ kind: 'invalid', participant, trial: trial.id, number: slot.number })}
          >
            Mark as invalid…
          </Button>
        ) : null}
      </td>
    </>
  );
}

function Line({
  slot,
  participant,
  ask,
}: {
  readonly slot: Slot;
  readonly participant: string;
  readonly ask: (action: StudyAction) => void;
}) {
  const head = (
    <th scope="row">
      {formatCount(slot.number)}
      {slot.repeat_of === null ? null : <span className={styles.repeat}> repeats {formatCount(slot.repeat_of)}</span>}
      {slot.scenario === null ? null : <span className={styles.repeat}> {slot.scenario}</span>}
    </th>
  );
  if (slot.trials.length === 0)
    return (
      <tr>
        {head}
        <td colSpan={7} className={styles.none}>
          {kSlot[slot.state]}
        </td>
      </tr>
    );
  return (
    <>
      {slot.trials.map((trial, i) => (
        <tr key={trial.id}>
          {i === 0 ? (
            head
          ) : (
            <th scope="row">
              <span className="hidden-visually">{formatCount(slot.number)}, again</span>
            </th>
          )}
          <TrialCells trial={trial} slot={slot} participant={participant} ask={ask} />
        </tr>
      ))}
    </>
  );
}

/** All trials of a participant, position by position. */
export function ParticipantTrials({ participant, ask }: Props) {
  return (
    <div className={styles.places}>
      <table className={styles.table}>
        <caption className="hidden-visually">Trials of {participant.name}</caption>
        <thead>
          <tr>
            <th scope="col">Position</th>
            <th scope="col">Trial</th>
            <th scope="col">Started</th>
            <th scope="col">Station</th>
            <th scope="col" className={styles.number}>
              Duration
            </th>
            <th scope="col" className={styles.number}>
              Samples
            </th>
            <th scope="col">Answer</th>
            <th scope="col">
              <span className="hidden-visually">Actions</span>
            </th>
          </tr>
        </thead>
        <tbody>
          {participant.slots.map((slot) => (
            <Line key={slot.number} slot={slot} participant={participant.name} ask={ask} />
          ))}
        </tbody>
      </table>
      {participant.at_station ? (
        <p>
          <Button onClick={() => ask({ kind: 'release', participant: participant.name })}>Release reservation…</Button>
        </p>
      ) : null}
    </div>
  );
}
