/** What a participant, a place and an event read as. */
import type { Participant, Slot, StudyEvent, StudyTrial } from '@/api';
import { formatCount, formatYears } from '@/units';

export function levelOf({ level, experience_years }: Participant): string {
  return [level, experience_years === null ? '' : formatYears(experience_years)].filter(Boolean).join(', ');
}

/** What a participant is at, and who brings it. */
export function doingOf(participant: Participant): { text: string; tone: 'good' | 'warn' | 'accent' | 'neutral' } {
  const left = participant.slots.some(({ state }) => state === 'waiting' || state === 'taken');
  if (!left) return { text: 'through', tone: 'good' };
  if (participant.state === 'paused') return { text: 'paused', tone: 'warn' };
  if (participant.at_station) return { text: 'at a station', tone: 'accent' };
  return { text: participant.done === 0 ? 'not begun' : 'to go on', tone: 'neutral' };
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

export const kMarkSign: Record<Mark, string> = { waiting: '', taken: '·', right: '✓', wrong: '✗', recorded: '●', invalid: '⊘' };
export const kMarkWord: Record<Mark, string> = {
  waiting: 'to be done', taken: 'at a station', right: 'done, recognised', wrong: 'done, not recognised', recorded: 'done, not judged', invalid: 'does not count',
};

const kSentences: Record<string, (who: string, whom: string) => string> = {
  made: (who) => `${who} made the study`,
  enrolled: (who, whom) => `${who} enrolled ${whom}`,
  taken: (who, whom) => `${who} took the next trial of ${whom}`,
  recorded: (who, whom) => `${who} brought a trial of ${whom}`,
  invalid: (who, whom) => `${who}: a trial of ${whom} does not count`,
  repeated: (who, whom) => `${who}: its place is repeated for ${whom}`,
  surplus: (who, whom) => `${who} brought a second trial of ${whom} for the same place`,
  released: (who, whom) => `${who} released a trial of ${whom}`,
  paused: (who, whom) => `${who} paused ${whom}`,
  running: (who, whom) => `${who} went on with ${whom}`,
};

/** "station-1 brought a trial of P03" */
export function sentenceOf({ who, what, participant, reason }: StudyEvent): string {
  const said = kSentences[what]?.(who, participant ?? 'the study') ?? `${who}: ${what}`;
  return reason === '' ? said : `${said} (${reason})`;
}

export const progressOf = ({ done, planned }: { readonly done: number; readonly planned: number }) => `${formatCount(done)} of ${formatCount(planned)}`;
