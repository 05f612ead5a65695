/** What a station's state is called, and how it looks; the word says it all, the colour only helps. */
import type { StationState } from '@/api';
import type { Tone } from '@/ui';

interface Word { readonly name: string; readonly tone: Tone; readonly means: string }

export const kStates: Record<StationState['state'], Word> = {
  away: { name: 'Away', tone: 'neutral', means: 'It is switched off, or cannot reach the server. What it records meanwhile is on its own disk.' },
  idle: { name: 'Free', tone: 'good', means: 'It waits for somebody to sign in.' },
  preparing: { name: 'Preparing', tone: 'accent', means: 'A case is loaded, or the device is brought to its start.' },
  trial: { name: 'In a trial', tone: 'accent', means: 'Somebody palpates or probes just now.' },
  questions: { name: 'Answering', tone: 'accent', means: 'The trial has ended; the person says what was felt.' },
  stopped: { name: 'Stopped', tone: 'warn', means: 'Somebody stopped it from here. A person at the station lets it go on.' },
  fault: { name: 'Fault', tone: 'bad', means: 'It has stopped itself with zero force. A person at the station has to look.' },
};

/** What needs a person comes first, then what is at work, then by name. */
const kOrder: readonly StationState['state'][] = ['fault', 'stopped', 'trial', 'questions', 'preparing', 'idle', 'away'];
export function inOrder(stations: readonly StationState[]): StationState[] {
  return [...stations].sort((a, b) => kOrder.indexOf(a.state) - kOrder.indexOf(b.state) || a.name.localeCompare(b.name));
}

export const isAtWork = ({ state }: StationState) => state === 'trial' || state === 'questions' || state === 'preparing';

/** "2 in a trial, 1 needs a person, 3 free, 1 away": what a glance should tell, also to who cannot see the colours. */
export function inShort(stations: readonly StationState[]): string {
  const count = (...states: StationState['state'][]) => stations.filter(({ state }) => states.includes(state)).length;
  const parts = [
    [count('trial', 'questions', 'preparing'), 'at work'], [count('fault', 'stopped'), 'waiting for a person there'], [count('idle'), 'free'], [count('away'), 'away'],
  ] as const;
  return parts.filter(([n]) => n > 0).map(([n, word]) => `${n} ${word}`).join(', ') || 'no stations';
}
