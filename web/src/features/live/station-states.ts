/** Name, colour and description of each state of a station. */
import type { StationState } from '@/api';
import type { Tone } from '@/ui';

interface StateLabel {
  readonly name: string;
  readonly tone: Tone;
  readonly description: string;
}

export const kStates: Record<StationState['state'], StateLabel> = {
  away: {
    name: 'Offline',
    tone: 'neutral',
    description: 'The station is switched off or cannot reach the server. It saves its recordings on its own disk.',
  },
  idle: { name: 'Available', tone: 'good', description: 'Waiting for a person to sign in.' },
  preparing: {
    name: 'Preparing',
    tone: 'accent',
    description: 'Loading a case, or moving the device to its start position.',
  },
  trial: { name: 'In a trial', tone: 'accent', description: 'A person is palpating or probing.' },
  questions: {
    name: 'Answering',
    tone: 'accent',
    description: 'The trial has ended; the person is answering the questions.',
  },
  stopped: {
    name: 'Stopped',
    tone: 'warn',
    description: 'Stopped from the server. A person at the station must resume operation.',
  },
  fault: {
    name: 'Fault',
    tone: 'bad',
    description: 'The station stopped itself with zero force. A person at the station must check it.',
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
    [count('trial', 'questions', 'preparing'), 'in use'],
    [count('fault', 'stopped'), 'needing attention'],
    [count('idle'), 'available'],
    [count('away'), 'offline'],
  ] as const;
  return (
    parts
      .filter(([n]) => n > 0)
      .map(([n, word]) => `${n} ${word}`)
      .join(', ') || 'no stations'
  );
}
