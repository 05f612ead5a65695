/** Name, colour and description of each state of a station. */
import type { StationState } from '@/api';
import { marked, say } from '@/language';
import type { Tone } from '@/ui';
import { formatCount } from '@/units';

interface StateLabel {
  readonly name: string;
  readonly tone: Tone;
  readonly description: string;
}

export const kStates: Record<StationState['state'], StateLabel> = {
  away: {
    name: marked('Offline'),
    tone: 'neutral',
    description: marked(
      'The station is switched off or cannot reach the server. It saves its recordings on its own disk.',
    ),
  },
  idle: { name: marked('Available'), tone: 'good', description: marked('Waiting for a person to sign in.') },
  preparing: {
    name: marked('Preparing'),
    tone: 'accent',
    description: marked('Loading a case, or moving the device to its start position.'),
  },
  trial: { name: marked('In a trial'), tone: 'accent', description: marked('A person is palpating or probing.') },
  questions: {
    name: marked('Answering'),
    tone: 'accent',
    description: marked('The trial has ended; the person is answering the questions.'),
  },
  stopped: {
    name: marked('Stopped'),
    tone: 'warn',
    description: marked('Stopped from the server. A person at the station must resume operation.'),
  },
  fault: {
    name: marked('Fault'),
    tone: 'bad',
    description: marked('The station stopped itself with zero force. A person at the station must check it.'),
  },
};

/** What needs a person comes first, then what is at work, then by name. */
const kOrder: readonly StationState['state'][] = [
  'fault',
  'stopped',
  'trial',
  'questions',
  'preparing',
  'idle',
  'away',
];
export function byUrgency(stations: readonly StationState[]): StationState[] {
  return [...stations].sort(
    (a, b) => kOrder.indexOf(a.state) - kOrder.indexOf(b.state) || a.name.localeCompare(b.name),
  );
}

export const isAtWork = ({ state }: StationState) =>
  state === 'trial' || state === 'questions' || state === 'preparing';

/** "2 in use, 1 needing attention, 3 available, 1 offline": the same as the colours, in words. */
export function summaryOf(stations: readonly StationState[]): string {
  const count = (...states: StationState['state'][]) => stations.filter(({ state }) => states.includes(state)).length;
  const parts = [
    [count('trial', 'questions', 'preparing'), marked('{n} in use')],
    [count('fault', 'stopped'), marked('{n} needing attention')],
    [count('idle'), marked('{n} available')],
    [count('away'), marked('{n} offline')],
  ] as const;
  return (
    parts
      .filter(([n]) => n > 0)
      .map(([n, words]) => say(words, { n: formatCount(n) }))
      .join(', ') || say('no stations')
  );
}
