/** Badge and PIN, by a scanner that types, by keys or by touch. */
import { say } from '@/language';
import { Button, LanguageSwitch } from '@/ui';
import type { Send } from './station';
import { useBadge, useTyped } from './typed';
import styles from './kiosk.module.css';

const kKeys = ['1', '2', '3', '4', '5', '6', '7', '8', '9'] as const;
const kLongestPin = 12,
  kShortestPin = 4;

interface PadProps {
  readonly onDigit: (digit: string) => void;
  readonly onDelete: () => void;
  readonly onEnter: () => void;
  readonly ready: boolean;
  readonly enter: string;
}

function Pad({ onDigit, onDelete, onEnter, ready, enter }: PadProps) {
  return (
    <div className={styles.pad}>
      {kKeys.map((key) => (
        <Button key={key} className={styles.key} onClick={() => onDigit(key)}>
          {key}
        </Button>
      ))}
      <Button className={styles.key} label={say('Delete')} onClick={onDelete}>
        ⌫
      </Button>
      <Button className={styles.key} onClick={() => onDigit('0')}>
        0
      </Button>
      <Button className={`${styles.key} ${styles.enter}`} look="solid" disabled={!ready} onClick={onEnter}>
        {enter}
      </Button>
    </div>
  );
}

interface BadgeProps {
  readonly study: boolean;
  readonly notice: string;
  /** The number that `notice` is about. */
  readonly refused_badge: string;
  readonly technician: boolean;
  readonly send: Send;
}

export function BadgeScreen({ study, notice, refused_badge, technician, send }: BadgeProps) {
  const [badge, setBadge, give] = useBadge(send);
  const add = (digit: string) => setBadge((text) => text + digit);
  return (
    <section className={styles.columns}>
      <div className={styles.words}>
        <h1>{study ? say('Type your participant number') : say('Scan your badge')}</h1>
        <p>
          {study
            ? say('It stands on the sheet that you were given for this study.')
            : say('Hold the badge to the scanner, or type its number.')}
        </p>
        {notice === '' ? null : (
          <p role="alert">
            {refused_badge}: {say(notice)}
          </p>
        )}
        <output className={styles.typed} aria-label={study ? say('Participant number') : say('Badge number')}>
          {badge === '' ? ' ' : badge}
        </output>
        <LanguageSwitch />
        {technician ? (
          <Button look="quiet" className={styles.small} onClick={() => send({ command: 'technician' })}>
            {say('Technician')}
          </Button>
        ) : null}
      </div>
      <Pad
        enter={say('Next')}
        ready={badge !== ''}
        onDigit={add}
        onDelete={() => setBadge((text) => text.slice(0, -1))}
        onEnter={give}
      />
    </section>
  );
}

interface PinProps {
  readonly title: string;
  readonly notice: string;
  readonly send: Send;
}

export function PinScreen({ title, notice, send }: PinProps) {
  const give = (pin: string) => send({ command: 'pin', pin });
  const [pin, setPin] = useTyped(/^\d$/, kLongestPin, give);
  const add = (digit: string) => setPin((text) => (text.length < kLongestPin ? text + digit : text));
  return (
    <section className={styles.columns}>
      <div className={styles.words}>
        <h1>{title}</h1>
        {notice === '' ? (
          <p>{say('Nobody else should see it.')}</p>
        ) : (
          <p role="alert">{say('{notice} Try again.', { notice: say(notice) })}</p>
        )}
        <output className={styles.typed} aria-label={say('Digits typed')}>
          {pin === '' ? ' ' : '●'.repeat(pin.length)}
        </output>
        <Button className={styles.wide} onClick={() => send({ command: 'back' })}>
          {say('Back')}
        </Button>
      </div>
      <Pad
        enter={say('OK')}
        ready={pin.length >= kShortestPin}
        onDigit={add}
        onDelete={() => setPin((text) => text.slice(0, -1))}
        onEnter={() => {
          give(pin);
          setPin(() => '');
        }}
      />
    </section>
  );
}
