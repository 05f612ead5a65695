/** Moments of a trial that one jumps to. */
import type { ForceDepth, Trial, TrialComment } from '@/api';
import { marked, say } from '@/language';

export interface Moment {
  readonly t_s: number;
  readonly text: string;
  readonly kind: 'event' | 'comment';
}

const kEventNames: Record<string, string> = {
  start: marked('start'),
  end: marked('end'),
  answer: marked('answer'),
  fault: marked('fault'),
  interrupted: marked('interrupted'),
};
const kUnmarked: readonly string[] = ['tare'];

/** Where the probe of the rig went through a wall. */
export function breaches(curve: ForceDepth | undefined): Moment[] {
  const out: Moment[] = [];
  curve?.mode.forEach((mode, i) => {
    if (mode === 'breach' && curve.mode[i - 1] !== 'breach')
      out.push({ t_s: curve.t_s[i] ?? 0, text: say('breach'), kind: 'event' });
  });
  return out;
}

/** In order of time. */
export function momentsOf(trial: Trial, comments: readonly TrialComment[], further: readonly Moment[]): Moment[] {
  const events = trial.events
    .filter(({ kind }) => !kUnmarked.includes(kind))
    .map(({ t_s, kind }) => ({ t_s, text: kEventNames[kind] ?? kind, kind: 'event' as const }));
  const commented = comments.flatMap(({ at_s, text }) =>
    at_s === null ? [] : [{ t_s: at_s, text, kind: 'comment' as const }],
  );
  return [...events, ...further, ...commented].sort((a, b) => a.t_s - b.t_s);
}

const kNear_s = 0.02;

/** The next moment after or before one; null: there is none. */
export function neighbour(moments: readonly Moment[], t_s: number, direction: 1 | -1): Moment | null {
  const found =
    direction > 0 ? moments.find((one) => one.t_s > t_s + kNear_s) : moments.findLast((one) => one.t_s < t_s - kNear_s);
  return found ?? null;
}
