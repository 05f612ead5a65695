import { useEffect, useEffectEvent, useState } from 'react';
import type { Send } from './station';

const kLongestBadge = 64;

/** Keys of a keyboard or a scanner, wherever the focus is. */
export function useTyped(
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

/** A badge that is scanned or typed on this screen: its text, a change of it, and that it is given as it stands. */
export function useBadge(send: Send): [string, (change: (text: string) => string) => void, () => void] {
  const give = (badge: string) => send({ command: 'badge', badge });
  const [badge, setBadge] = useTyped(/^[\x21-\x7e]$/, kLongestBadge, give);
  return [badge, (change) => setBadge((text) => change(text).slice(0, kLongestBadge)), () => give(badge)];
}
