/** From the next trial to its result. */
import { say } from '@/language';
import { Badge, Button, Progress, wallName } from '@/ui';
import { formatLength, formatScore, formatShare, formatTime, metre, second, share } from '@/units';
import type { Result, Send, State, Work } from './station';
import styles from './kiosk.module.css';

type Live = NonNullable<State['live']>;
type Outcome = NonNullable<State['outcome']>;

/** How the tool is held, in the order in which it is done. */
function holding({ rig, tool }: Pick<Work, 'rig' | 'tool'>): readonly string[] {
  if (tool === 'burr')
    return [
      say('Hold the handle like a pen, the arm at rest.'),
      say('Bring the tip to the entry, then press and hold the button: the burr cuts.'),
      say('Let the button go when the channel is deep enough.'),
    ];
  if (rig === 'probing')
    return [
      say('Hold the handle in your palm, in line with your forearm.'),
      say('Push forward evenly and turn to and fro.'),
      say('Stop pushing when you feel that a wall gives way.'),
    ];
  return [
    say('Hold the handle like a pen, the arm at rest.'),
    say('Lead the tip into the channel; feel the bottom first.'),
    say('Stroke each wall from the bottom to the entry.'),
  ];
}

export function WaitScreen({ text }: { readonly text: string }) {
  return (
    <section className={styles.centre} role="status">
      <h1>{text}…</h1>
    </section>
  );
}

export function WorkScreen({
  work,
  button,
  send,
}: {
  readonly work: Work;
  /** The device has a button that starts as well. */
  readonly button: boolean;
  readonly send: Send;
}) {
  return (
    <section className={styles.columns}>
      <div className={styles.words}>
        <p className={styles.small}>{work.assignment}</p>
        <h1>{work.name}</h1>
        <p>
          {say(
            'Trial {number} of {planned}. {left, plural, one {It is your last one today.} other {You have # trials to do.}}',
            { number: work.number, planned: work.planned, left: work.left },
          )}
        </p>
        <ol className={styles.steps}>
          {holding(work).map((step) => (
            <li key={step}>{step}</li>
          ))}
        </ol>
      </div>
      <div className={styles.actions}>
        <Button look="solid" className={styles.main_button} onClick={() => send({ command: 'start' })}>
          {say('Start')}
        </Button>
        {button ? <p className={styles.small}>{say('Or press the button of the device.')}</p> : null}
        <Button className={styles.wide} onClick={() => send({ command: 'pause' })}>
          {say('Pause')}
        </Button>
        <Button className={styles.wide} onClick={() => send({ command: 'sign_out' })}>
          {say('Sign out')}
        </Button>
      </div>
    </section>
  );
}

function heading({ rig, tool }: Pick<Work, 'rig' | 'tool'>): string {
  if (tool === 'burr') return say('Drill');
  return rig === 'probing' ? say('Probe the bone') : say('Feel the walls');
}

export function RunningScreen({
  live,
  work,
  send,
}: {
  readonly live: Live;
  readonly work: Work | undefined;
  readonly send: Send;
}) {
  return (
    <section className={styles.columns}>
      <div className={styles.words}>
        <h1>{heading(work ?? { rig: 'palpation', tool: 'probe' })}</h1>
        <dl className={styles.readings}>
          <div>
            <dt>{say('Time')}</dt>
            <dd>{formatTime(second(Math.floor(live.t_s)), 0)}</dd>
          </div>
          {live.depth_m === null ? null : (
            <div>
              <dt>{say('Depth')}</dt>
              <dd>{formatLength(metre(live.depth_m), 0)}</dd>
            </div>
          )}
        </dl>
        {live.progress === null ? (
          <p>{say('This trial shows no depth.')}</p>
        ) : (
          <>
            <Progress done={live.progress} of={1} label={say("Share of the trial's time")} />
            <p>{say("{share} of the trial's time", { share: formatShare(share(live.progress)) })}</p>
          </>
        )}
      </div>
      <div className={styles.actions}>
        <Button className={styles.main_button} onClick={() => send({ command: 'end_trial' })}>
          {say('I am done')}
        </Button>
        <Button className={styles.wide} onClick={() => send({ command: 'pause' })}>
          {say('Pause')}
        </Button>
      </div>
    </section>
  );
}

function answerText({ answer, drilled }: Outcome): string {
  if (drilled) return say('The channel that you drilled is kept. You feel it in a later trial.');
  if (answer === null) return say('The trial is kept without an answer.');
  const wall = answer.wall === null ? '' : wallName(answer.wall);
  if (answer.confidence === undefined)
    return answer.breach ? say('Your answer: breach of the {wall} wall.', { wall }) : say('Your answer: no breach.');
  const sure = formatShare(share(answer.confidence));
  return answer.breach
    ? say('Your answer: breach of the {wall} wall, {sure} sure.', { wall, sure })
    : say('Your answer: no breach, {sure} sure.', { sure });
}

/** The answer and the scores as the trainee's own page shows them, as far as they are released. */
function Scores({ result }: { readonly result: Result | null }) {
  if (result === null || result.state === 'assessing')
    return <p role="status">{say('The result is being computed…')}</p>;
  if (result.state === 'held') return <p>{say('You see the result on your own page once it is released.')}</p>;
  if (result.state === 'failed') return <p>{say('The trial could not be assessed. The faculty sees why.')}</p>;
  return (
    <>
      {result.correct === null ? null : (
        <p>
          <Badge tone={result.correct ? 'good' : 'bad'}>
            {result.correct ? say('✓ correct') : say('✗ not correct')}
          </Badge>
        </p>
      )}
      <dl className={styles.scores}>
        {result.scores.map((score) => (
          <div key={score.label}>
            <dt>{say(score.label)}</dt>
            <dd>{formatScore(score)}</dd>
          </div>
        ))}
      </dl>
    </>
  );
}

interface ResultProps {
  readonly study: boolean;
  readonly outcome: Outcome;
  readonly send: Send;
}

export function ResultScreen({ study, outcome, send }: ResultProps) {
  return (
    <section className={styles.columns}>
      <div className={styles.words}>
        <h1>{say('Trial done')}</h1>
        <p>{answerText(outcome)}</p>
        {outcome.sent ? (
          <>
            <p>{say('The server has it.')}</p>
            {study ? <p>{say('Nobody sees results of this study before all your trials are done.')}</p> : null}
            {study || outcome.drilled ? null : <Scores result={outcome.result} />}
          </>
        ) : (
          <p>{say('The server does not answer. The trial is safe at this station and is sent later by itself.')}</p>
        )}
      </div>
      <div className={styles.actions}>
        <Button look="solid" className={styles.main_button} onClick={() => send({ command: 'next' })}>
          {say('Next trial')}
        </Button>
        <Button className={styles.wide} onClick={() => send({ command: 'pause' })}>
          {say('Pause')}
        </Button>
        <Button className={styles.wide} onClick={() => send({ command: 'sign_out' })}>
          {say('Sign out')}
        </Button>
      </div>
    </section>
  );
}

/** The trial stands still: no force, and its time does not pass. */
function PausedTrial({ send }: { readonly send: Send }) {
  return (
    <section className={styles.centre}>
      <h1>{say('Paused')}</h1>
      <p>
        {say(
          'The handle is without force, and the time of the trial does not pass. Take the tip off the wall before you go on: the force comes back slowly. After 15 minutes the trial ends.',
        )}
      </p>
      <Button look="solid" className={styles.main_button} onClick={() => send({ command: 'resume' })}>
        {say('Go on')}
      </Button>
      <Button className={styles.wide} onClick={() => send({ command: 'end_trial' })}>
        {say('I am done')}
      </Button>
    </section>
  );
}

export function PausedScreen({ inTrial, send }: { readonly inTrial: boolean; readonly send: Send }) {
  if (inTrial) return <PausedTrial send={send} />;
  return (
    <section className={styles.centre}>
      <h1>{say('Paused')}</h1>
      <p>{say('After 15 minutes you are signed out. Nothing is lost.')}</p>
      <Button look="solid" className={styles.main_button} onClick={() => send({ command: 'resume' })}>
        {say('Go on')}
      </Button>
      <Button className={styles.wide} onClick={() => send({ command: 'sign_out' })}>
        {say('Sign out')}
      </Button>
    </section>
  );
}

export function CompleteScreen({ send }: { readonly send: Send }) {
  return (
    <section className={styles.centre}>
      <h1>{say('Nothing is left to do')}</h1>
      <p>{say('No trial of yours waits for this station now.')}</p>
      <Button look="solid" className={styles.main_button} onClick={() => send({ command: 'sign_out' })}>
        {say('Sign out')}
      </Button>
    </section>
  );
}
