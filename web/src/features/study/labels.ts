/** Labels of participants, trials and events of a study. */
import type { Participant, Slot, StudyEvent, StudyTrial } from '@/api';
import { formatCount, formatYears } from '@/units';

export function levelOf({ level, experience_years }: Participant): string {
  return [level, experience_years === null ? '' : formatYears(experience_years)].filter(Boolean).join(', ');
}

/** Status of a participant in the study. */
export function statusOf(participant: Participant): { text: string; tone: 'good' | 'warn' | 'accent' | 'neutral' } {
  const left = participant.slots.some(({ state }) => state === 'waiting' || state === 'taken');
  if (!left) return { text: 'complete', tone: 'good' };
  if (participant.state === 'paused') return { text: 'paused', tone: 'warn' };
  if (participant.at_station) return { text: 'at a station', tone: 'accent' };
  return { text: participant.done === 0 ? 'not started' : 'in progress', tone: 'neutral' };
}

/** The trial of a place that matters: the one that counts, or else the last. */
export function trialOf({ trials }: Slot): StudyTrial | undefined {
  return trials.find(({ state }) => state === 'counts') ?? trials.at(-1);
}

export type Mark = 'waiting' | 'taken' | 'right' | 'wrong' | 'recorded' | 'invalid';

export function markOf(slot: Slot): Mark {
  if (slot.state !== 'recorded') return slot.state;
  const correct = trialOf(slot)?.correct;
  return correct === true ? 'right' : correct === false ? 'wrong' : 'recorded';
}

export const kMarkSign: Record<Mark, string> = {
  waiting: '',
  taken: '·',
  right: '✓',
  wrong: '✗',
  recorded: '●',
  invalid: '⊘',
};
export const kMarkLabel: Record<Mark, string> = {
  waiting: 'not started',
  taken: 'at a station',
  right: 'done, recognised',
  wrong: 'done, not recognised',
  recorded: 'done, not assessed',
  invalid: 'invalid',
};

const kSentences: Record<string, (who: string, whom: string) => string> = {
  made: (who) => `${who} created the study`,
  enrolled: (who, whom) => `${who} enrolled ${whom}`,
  taken: (who, whom) => `${who} reserved the next trial of ${whom}`,
  recorded: (who, whom) => `${who} uploaded a trial of ${whom}`,
  invalid: (who, whom) => `${who} marked a trial of ${whom} as invalid`,
  repeated: (who, whom) => `${who} added a repeat for ${whom}`,
  surplus: (who, whom) => `${who} uploaded a surplus trial of ${whom}`,
  released: (who, whom) => `${who} released the reservation for ${whom}`,
  paused: (who, whom) => `${who} paused ${whom}`,
  running: (who, whom) => `${who} resumed ${whom}`,
};

/** "station-1 uploaded a trial of P03" */
export function eventSentence({ who, what, participant, reason }: StudyEvent): string {
  const sentence = kSentences[what]?.(who, participant ?? 'the study') ?? `${who}: ${what}`;
  return reason === '' ? sentence : `${sentence} (${reason})`;
}

export const progressOf = ({ done, planned }: { readonly done: number; readonly planned: number }) =>
  `${formatCount(done)} of ${formatCount(planned)}`;
