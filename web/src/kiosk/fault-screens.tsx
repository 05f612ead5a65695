/** What went wrong, in words for whoever stands there, and what they may do. */
import { marked, say } from '@/language';
import { Button } from '@/ui';
import type { Connection, FaultKind, Send, State } from './station';
import { useBadge } from './typed';
import styles from './kiosk.module.css';

type Fault = NonNullable<State['fault']>;

interface Words {
  readonly title: string;
  readonly todo: string;
  /** What stands on the button that goes on. */
  readonly retry?: string;
}

const kWords: Record<FaultKind, Words> = {
  interrupted: {
    title: marked('A trial was interrupted'),
    todo: marked(
      'The station lost power or was started again in the middle of a trial. What was recorded is kept and is sent by itself. Sign in to go on.',
    ),
  },
  timed_out: {
    title: marked('You were signed out'),
    todo: marked('Nobody touched the screen for a while. Nothing is lost. Sign in again to go on.'),
  },
  network: {
    title: marked('No network'),
    todo: marked(
      'The server does not answer. Trials that you did are safe at this station and are sent later. Wait a minute and try again; if it stays, tell a technician.',
    ),
    retry: marked('Try again'),
  },
  locked: {
    title: marked('Too many wrong PINs'),
    todo: marked('Wait three minutes before the next try. If you forgot your PIN, ask the faculty for a new one.'),
  },
  device: {
    title: marked('The device does not work'),
    todo: marked(
      'Let go of the handle. Look whether the device is switched on and plugged in. If “Try again” does not help, tell a technician.',
    ),
    retry: marked('Try again'),
  },
  emergency_stop: {
    title: marked('Emergency stop'),
    todo: marked(
      'Everything is without force. When it is safe: release the red button, press reset at the rig, then go on here.',
    ),
    retry: marked('It is safe: go on'),
  },
  stopped: {
    title: marked('Stopped by a supervisor'),
    todo: marked('Let go of the handle and speak with your supervisor before you go on.'),
    retry: marked('Go on'),
  },
  work: {
    title: marked('This trial cannot be done here'),
    todo: marked('It is not your fault, and nothing is lost. Tell the faculty or a technician what stands below.'),
    retry: marked('Try again'),
  },
};

/** A badge may be scanned here as well. */
function SignIn({ send }: { readonly send: Send }) {
  useBadge(send);
  return (
    <Button look="solid" className={styles.main_button} onClick={() => send({ command: 'back' })}>
      {say('Sign in')}
    </Button>
  );
}

export function FaultScreen({
  fault,
  waiting,
  send,
}: {
  readonly fault: Fault;
  readonly waiting: number;
  readonly send: Send;
}) {
  const { title, todo, retry } = kWords[fault.kind];
  return (
    <section className={styles.fault} data-fault={fault.kind} role="alert">
      <h1>{say(title)}</h1>
      <p>{say(todo)}</p>
      {waiting > 0 ? (
        <p>
          {say('{waiting, plural, one {# trial is} other {# trials are}} kept here and not sent yet.', { waiting })}
        </p>
      ) : null}
      <div className={styles.row}>
        {fault.signed_in ? (
          <>
            <Button look="solid" className={styles.main_button} onClick={() => send({ command: 'retry' })}>
              {say(retry ?? marked('Go on'))}
            </Button>
            <Button className={styles.wide} onClick={() => send({ command: 'sign_out' })}>
              {say('Sign out')}
            </Button>
          </>
        ) : (
          <SignIn send={send} />
        )}
      </div>
      {fault.what === '' ? null : <p className={styles.small}>{fault.what}</p>}
    </section>
  );
}

export function LostScreen({
  connection,
  onConnect,
}: {
  readonly connection: Connection;
  readonly onConnect: () => void;
}) {
  const elsewhere = connection === 'elsewhere';
  return (
    <section className={styles.fault} data-fault={connection} role="alert">
      <h1>{elsewhere ? say('The station has ended, or is shown elsewhere') : say('The station does not answer')}</h1>
      <p>
        {elsewhere
          ? say('Another window shows this station, or it was switched off in good order.')
          : say(
              'Let go of the handle. The station starts again by itself in a moment; what was recorded is kept. If this stays for a minute, tell a technician.',
            )}
      </p>
      {elsewhere ? (
        <Button look="solid" className={styles.main_button} onClick={onConnect}>
          {say('Show it here')}
        </Button>
      ) : null}
    </section>
  );
}
