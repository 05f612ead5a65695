/** What went wrong, in words for whoever stands there, and what they may do. */
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
    title: 'A trial was interrupted',
    todo: 'The station lost power or was started again in the middle of a trial. What was recorded is kept and is sent by itself. Sign in to go on.',
  },
  timed_out: {
    title: 'You were signed out',
    todo: 'Nobody touched the screen for a while. Nothing is lost. Sign in again to go on.',
  },
  network: {
    title: 'No network',
    todo: 'The server does not answer. Trials that you did are safe at this station and are sent later. Wait a minute and try again; if it stays, tell a technician.',
    retry: 'Try again',
  },
  locked: {
    title: 'Too many wrong PINs',
    todo: 'Wait three minutes before the next try. If you forgot your PIN, ask the faculty for a new one.',
  },
  device: {
    title: 'The device does not work',
    todo: 'Let go of the handle. Look whether the device is switched on and plugged in. If “Try again” does not help, tell a technician.',
    retry: 'Try again',
  },
  emergency_stop: {
    title: 'Emergency stop',
    todo: 'Everything is without force. When it is safe: release the red button, press reset at the rig, then go on here.',
    retry: 'It is safe: go on',
  },
  stopped: {
    title: 'Stopped by a supervisor',
    todo: 'Let go of the handle and speak with your supervisor before you go on.',
    retry: 'Go on',
  },
  work: {
    title: 'This trial cannot be done here',
    todo: 'It is not your fault, and nothing is lost. Tell the faculty or a technician what stands below.',
    retry: 'Try again',
  },
};

/** A badge may be scanned here as well. */
function SignIn({ send }: { readonly send: Send }) {
  useBadge(send);
  return (
    <Button look="solid" className={styles.main_button} onClick={() => send({ command: 'back' })}>
      Sign in
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
      <h1>{title}</h1>
      <p>{todo}</p>
      {waiting > 0 ? (
        <p>{waiting === 1 ? '1 trial is' : `${String(waiting)} trials are`} kept here and not sent yet.</p>
      ) : null}
      <div className={styles.row}>
        {fault.signed_in ? (
          <>
            <Button look="solid" className={styles.main_button} onClick={() => send({ command: 'retry' })}>
              {retry ?? 'Go on'}
            </Button>
            <Button className={styles.wide} onClick={() => send({ command: 'sign_out' })}>
              Sign out
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
      <h1>{elsewhere ? 'The station has ended, or is shown elsewhere' : 'The station does not answer'}</h1>
      <p>
        {elsewhere
          ? 'Another window shows this station, or it was switched off in good order.'
          : 'Let go of the handle. The station starts again by itself in a moment; what was recorded is kept. If this stays for a minute, tell a technician.'}
      </p>
      {elsewhere ? (
        <Button look="solid" className={styles.main_button} onClick={onConnect}>
          Show it here
        </Button>
      ) : null}
    </section>
  );
}
