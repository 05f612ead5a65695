/** Badge and PIN, by a scanner that types, by keys or by touch. */
import { useEffect, useEffectEvent, useState } from 'react';
import { Button } from '@/ui';
import type { Send } from './station';
import styles from './kiosk.module.css';

const kKeys = ['1', '2', '3', '4', '5', '6', '7', '8', '9'] as const;
const kLongestBadge = 64,
  kLongestPin = 12,
  kShortestPin = 4;

/** Keys of a keyboard or a scanner, wherever the focus is. */
function useTyped(
  allowed: RegExp,
  longest: number,
  onEnter: (text: string) => void,
): [string, (change: (text: string) => string) => void] {
  const [text, setText] = useState('');
  const onKey = useEffectEvent((event: KeyboardEvent) => {
    if (event.ctrlKey || event.altKey || event.metaKey) return;
    if (event.key === 'Enter') {
      event.preventDefault();
      if (text !== '') onEnter(text);
      setText('');
    } else if (event.key === 'Backspace') setText(text.slice(0, -1));
    else if (event.key.length === 1 && allowed.test(event.key) && text.length < longest) setText(text + event.key);
  });
  useEffect(() => {
    const listener = (event: KeyboardEvent) => onKey(event);
    window.addEventListener('keydown', listener);
    return () => window.removeEventListener('keydown', listener);
  }, []);
  return [text, setText];
}

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
      <Button className={styles.key} label="Delete" onClick={onDelete}>
        ⌫
      </Button>
      <Button className={styles.key} onClick={() => onDigit('0')}>
        0
      </Button>
      <Button className={styles.key} look="solid" disabled={!ready} onClick={onEnter}>
        {enter}
      </Button>
    </div>
  );
}

export function BadgeScreen({ send }: { readonly send: Send }) {
  const give = (badge: string) => send({ command: 'badge', badge });
  const [badge, setBadge] = useTyped(/^[\x21-\x7e]$/, kLongestBadge, give);
  const add = (digit: string) => setBadge((text) => (text.length < kLongestBadge ? text + digit : text));
  return (
    <section className={styles.columns}>
      <div className={styles.words}>
        <h1>Scan your badge</h1>
        <p>Hold the badge to the scanner, or type its number.</p>
        <output className={styles.typed} aria-label="Badge number">
          {badge === '' ? ' ' : badge}
        </output>
      </div>
      <Pad
        enter="Next"
        ready={badge !== ''}
        onDigit={add}
        onDelete={() => setBadge((text) => text.slice(0, -1))}
        onEnter={() => give(badge)}
      />
    </section>
  );
}

export function PinScreen({ notice, send }: { readonly notice: string; readonly send: Send }) {
  const give = (pin: string) => send({ command: 'pin', pin });
  const [pin, setPin] = useTyped(/^\d$/, kLongestPin, give);
  const add = (digit: string) => setPin((text) => (text.length < kLongestPin ? text + digit : text));
  return (
    <section className={styles.columns}>
      <div className={styles.words}>
        <h1>Type your PIN</h1>
        {notice === '' ? <p>Nobody else should see it.</p> : <p role="alert">{notice} Try again.</p>}
        <output className={styles.typed} aria-label="Digits typed">
          {pin === '' ? ' ' : '●'.repeat(pin.length)}
        </output>
        <Button className={styles.wide} onClick={() => send({ command: 'back' })}>
          Not me: back
        </Button>
      </div>
      <Pad
        enter="Sign in"
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
