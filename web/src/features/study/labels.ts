/** Labels of participants, trials and events of a study. */
import type { Participant, Slot, StudyEvent, StudyTrial } from '@/api';
import { marked, say } from '@/language';
import { formatCount, formatYears } from '@/units';

export function levelOf({ level, experience_years }: Participant): string {
  return [level, experience_years === null ? '' : formatYears(experience_years)].filter(Boolean).join(', ');
}

/** Status of a participant in the study; the text is English, to be said. */
export function statusOf(participant: Participant): { text: string; tone: 'good' | 'warn' | 'accent' | 'neutral' } {
  const left = participant.slots.some(({ state }) => state === 'waiting' || state === 'taken');
  if (!left) return { text: marked('complete'), tone: 'good' };
  if (participant.state === 'paused') return { text: marked('paused'), tone: 'warn' };
  if (participant.at_station) return { text: marked('at a station'), tone: 'accent' };
  return { text: participant.done === 0 ? marked('not started') : marked('in progress'), tone: 'neutral' };
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
  waiting: marked('not started'),
  taken: marked('at a station'),
  right: marked('done, recognised'),
  wrong: marked('done, not recognised'),
  recorded: marked('done, not assessed'),
  invalid: marked('invalid'),
};

const kSentences: Readonly<Record<string, string>> = {
  made: marked('{who} created the study'),
  enrolled: marked('{who} enrolled {whom}'),
  taken: marked('{who} reserved the next trial of {whom}'),
  recorded: marked('{who} uploaded a trial of {whom}'),
  invalid: marked('{who} marked a trial of {whom} as invalid'),
  repeated: marked('{who} added a repeat for {whom}'),
  surplus: marked('{who} uploaded a surplus trial of {whom}'),
  released: marked('{who} released the reservation for {whom}'),
  paused: marked('{who} paused {whom}'),
  running: marked('{who} resumed {whom}'),
};
const kOfStudy: Readonly<Record<string, string>> = {
  paused: marked('{who} paused the study'),
  running: marked('{who} resumed the study'),
};

/** "station-1 uploaded a trial of P03" */
export function eventSentence({ who, what, participant, reason }: StudyEvent): string {
  const pattern = (participant === null ? kOfStudy[what] : undefined) ?? kSentences[what];
  const sentence =
    pattern === undefined ? `${who}: ${what}` : say(pattern, { who, whom: participant ?? say('the study') });
  return reason === '' ? sentence : `${sentence} (${reason})`;
}

export const progressOf = ({ done, planned }: { readonly done: number; readonly planned: number }) =>
  say('{done} of {planned}', { done: formatCount(done), planned: formatCount(planned) });
