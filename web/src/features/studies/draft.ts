/** A study as it is being written: text in, what the server takes out, with a sentence for everything that is missing. */
import Papa from 'papaparse';
import type { NewParticipant, NewStudy } from '@/api';
import { marked, say } from '@/language';

export const kTuned = [
  { id: 'hard', label: marked('Hard bone') },
  { id: 'soft', label: marked('Soft bone') },
  { id: 'lateral_breach', label: marked('Lateral breach') },
  { id: 'in_out_in', label: marked('In, out and in again') },
] as const;
export type Tuned = (typeof kTuned)[number]['id'];

/** A scenario from a file, as it was read. */
export interface Uploaded {
  readonly file: string;
  readonly scenario: Record<string, unknown>;
}

export interface Draft {
  readonly title: string;
  readonly id: string;
  readonly tuned: readonly Tuned[];
  readonly uploaded: readonly Uploaded[];
  readonly repeats: string;
  readonly ordering: 'random' | 'balanced';
  readonly onInvalid: 'at_end' | 'at_once' | 'never';
  /** One participant a line: pseudonym, level, years of experience, "simulated". */
  readonly participants: string;
}

export const kBlank: Draft = {
  title: '',
  id: '',
  tuned: kTuned.map(({ id }) => id),
  uploaded: [],
  repeats: '3',
  ordering: 'random',
  onInvalid: 'at_end',
  participants: '',
};

/** "Spine study, 2026" → "spine-study-2026" */
export function idOf(title: string): string {
  return title
    .toLowerCase()
    .normalize('NFD')
    .replace(/\p{M}/gu, '')
    .replace(/[^a-z0-9]+/g, '-')
    .replace(/^-+|-+$/g, '')
    .slice(0, 32)
    .replace(/-+$/, '');
}

const kPseudonym = /^[A-Za-z0-9_-]{1,32}$/;

function participant(cells: readonly string[]): NewParticipant | string {
  const [name = '', ...rest] = cells.map((part) => part.trim());
  const line = cells.join(',').trim();
  if (!kPseudonym.test(name))
    return say('“{name}” is not a valid pseudonym: use 1 to 32 letters, digits, - or _.', { name });
  const simulated = rest.some((part) => part.toLowerCase() === 'simulated');
  const others = rest.filter((part) => part !== '' && part.toLowerCase() !== 'simulated');
  const numbers = others.filter((part) => Number.isFinite(Number(part))),
    words = others.filter((part) => !Number.isFinite(Number(part)));
  if (numbers.length > 1 || words.length > 1)
    return say('“{line}”: expected pseudonym, level, years of experience.', { line });
  const years = numbers[0] === undefined ? undefined : Number(numbers[0]);
  if (years !== undefined && (years < 0 || years > 80))
    return say('“{line}”: years of experience must be 0 to 80.', { line });
  return {
    name,
    ...(words[0] === undefined ? {} : { level: words[0] }),
    ...(years === undefined ? {} : { experience_years: years }),
    ...(simulated ? { simulated } : {}),
  };
}

export interface Enrolled {
  readonly participants: NewParticipant[];
  readonly faults: string[];
}

export function participantsOf(text: string): Enrolled {
  const { data: lines, errors } = Papa.parse<string[]>(text, { delimiter: ',', skipEmptyLines: 'greedy' });
  if (errors.length > 0) return { participants: [], faults: [say('A quotation mark is missing or misplaced.')] };
  const participants: NewParticipant[] = [],
    faults: string[] = [];
  for (const cells of lines) {
    const read = participant(cells);
    if (typeof read === 'string') faults.push(read);
    else if (participants.some(({ name }) => name === read.name))
      faults.push(say('{name} is listed twice.', { name: read.name }));
    else participants.push(read);
  }
  return { participants, faults };
}

/** What the server takes, or what is still missing. */
export function studyOf(draft: Draft): { study: NewStudy } | { faults: string[] } {
  const { participants, faults } = participantsOf(draft.participants);
  const id = draft.id === '' ? idOf(draft.title) : draft.id;
  const repeats = Number(draft.repeats);
  const scenarios = [...draft.tuned.map((tuned) => ({ tuned })), ...draft.uploaded.map(({ scenario }) => scenario)];
  const missing = [
    ...(draft.title.trim() === '' ? [say('Enter a title.')] : []),
    ...(/^[a-z0-9][a-z0-9-]{0,31}$/.test(id)
      ? []
      : [say('The short name must have 1 to 32 characters: a–z, 0–9 and -.')]),
    ...(scenarios.length > 0 && scenarios.length <= 16 ? [] : [say('Choose 1 to 16 scenarios.')]),
    ...(Number.isInteger(repeats) && repeats >= 1 && repeats <= 20
      ? []
      : [say('Each scenario must be repeated 1 to 20 times.')]),
    ...faults,
  ];
  if (missing.length > 0) return { faults: missing };
  return {
    study: {
      id,
      title: draft.title.trim(),
      scenarios: scenarios as NewStudy['scenarios'], // files of people: the server checks them
      repeats,
      ordering: draft.ordering,
      on_invalid: draft.onInvalid,
      participants,
    },
  };
}
