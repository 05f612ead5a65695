import { Link } from 'wouter';
import type { Participant, Slot, StudyTrial } from '@/api';
import { marked, say } from '@/language';
import { Badge, Button, type Tone } from '@/ui';
import { formatClock, formatCount, formatDuration, isoDateTime, kNone } from '@/units';
import type { StudyAction } from './action-dialog';
import styles from './participant-trials.module.css';

interface Props {
  readonly participant: Participant;
  readonly ask: (action: StudyAction) => void;
}

const kTrial: Record<StudyTrial['state'], { word: string; tone: Tone }> = {
  arriving: { word: marked('uploading'), tone: 'accent' },
  counts: { word: marked('valid'), tone: 'good' },
  invalid: { word: marked('invalid'), tone: 'warn' },
  surplus: { word: marked('surplus'), tone: 'warn' },
};
const kSlot: Record<Slot['state'], string> = {
  waiting: marked('not started'),
  taken: marked('at a station'),
  recorded: marked('done'),
  invalid: marked('invalid'),
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
        <Badge tone={tone}>{say(word)}</Badge>
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
      <td>{trial.correct === null ? kNone : trial.correct ? say('✓ correct') : say('✗ incorrect')}</td>
      <td className={styles.actions}>
        {arrived ? <Link href={`/trials/${encodeURIComponent(trial.id)}`}>{say('Open')}</Link> : null}
        {trial.state === 'counts' ? (
          <Button
            look="quiet"
            label={say('Mark as invalid: trial {number} of {name}', {
              number: formatCount(slot.number),
              name: participant,
            })}
            onClick={() => ask({ kind: 'invalid', participant, trial: trial.id, number: slot.number })}
          >
            {say('Mark as invalid…')}
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
      {slot.repeat_of === null ? null : (
        <span className={styles.repeat}> {say('repeats {number}', { number: formatCount(slot.repeat_of) })}</span>
      )}
      {slot.scenario === null ? null : <span className={styles.repeat}> {slot.scenario}</span>}
    </th>
  );
  if (slot.trials.length === 0)
    return (
      <tr>
        {head}
        <td colSpan={7} className={styles.none}>
          {say(kSlot[slot.state])}
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
              <span className="hidden-visually">{say('{number}, again', { number: formatCount(slot.number) })}</span>
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
        <caption className="hidden-visually">{say('Trials of {name}', { name: participant.name })}</caption>
        <thead>
          <tr>
            <th scope="col">{say('Position')}</th>
            <th scope="col">{say('Trial')}</th>
            <th scope="col">{say('Started')}</th>
            <th scope="col">{say('Station')}</th>
            <th scope="col" className={styles.number}>
              {say('Duration')}
            </th>
            <th scope="col" className={styles.number}>
              {say('Samples')}
            </th>
            <th scope="col">{say('Answer')}</th>
            <th scope="col">
              <span className="hidden-visually">{say('Actions')}</span>
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
          <Button onClick={() => ask({ kind: 'release', participant: participant.name })}>
            {say('Release reservation…')}
          </Button>
        </p>
      ) : null}
    </div>
  );
}
