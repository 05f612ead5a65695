/** A rubric as it is being written. Pure. */
import type { RubricItem } from '@/api';

/** What is typed stays text until it is sent. */
export interface ItemDraft {
  readonly key: number;
  readonly label: string;
  readonly text: string;
  readonly low: string;
  readonly high: string;
  readonly low_text: string;
  readonly middle_text: string;
  readonly high_text: string;
}

const kLargestPoint = 10;
let made = 0;
export function newItem(of?: Partial<RubricItem>): ItemDraft {
  made += 1;
  return {
    key: made,
    label: of?.label ?? '',
    text: of?.text ?? '',
    low: String(of?.low ?? 1),
    high: String(of?.high ?? 5),
    low_text: of?.low_text ?? '',
    middle_text: of?.middle_text ?? '',
    high_text: of?.high_text ?? '',
  };
}

const whole = (text: string) => (/^\d+$/.test(text.trim()) ? Number(text) : NaN);

/** What is wrong with the item; empty if nothing is. */
export function itemProblem(of: ItemDraft): string {
  if (of.label.trim() === '') return 'Name the item.';
  const low = whole(of.low),
    high = whole(of.high);
  if (!(low >= 0 && high <= kLargestPoint)) return `Points from 0 to ${kLargestPoint} are expected.`;
  if (!(high > low)) return 'The high end must have more points than the low end.';
  if (of.low_text.trim() === '' || of.high_text.trim() === '') return 'Describe both ends.';
  return '';
}

export const itemOf = (of: ItemDraft): RubricItem => ({
  label: of.label.trim(),
  text: of.text.trim(),
  low: whole(of.low),
  high: whole(of.high),
  low_text: of.low_text.trim(),
  middle_text: of.middle_text.trim(),
  high_text: of.high_text.trim(),
});

/** "Global rating scale" → "global_rating_scale". */
export const idFrom = (title: string) =>
  title
    .toLowerCase()
    .replace(/[^a-z0-9]+/g, '_')
    .replace(/^[^a-z]+|_+$/g, '')
    .slice(0, 32);

const item = (label: string, low_text: string, middle_text: string, high_text: string) => ({
  label,
  low_text,
  middle_text,
  high_text,
});

/** The seven items of OSATS' global rating scale [Martin1997], described in our own words. */
export const kGlobalRating: readonly Partial<RubricItem>[] = [
  item(
    'Respect for tissue',
    'Often uses more force than needed, or harms tissue by careless handling',
    'Handles tissue carefully, with a slip now and then',
    'Handles tissue carefully throughout and harms it as little as can be',
  ),
  item('Time and motion', 'Makes many needless moves', 'Efficient, with some needless moves', 'No needless move'),
  item(
    'Handling of instruments',
    'Moves are hesitant or awkward',
    'Competent, at times stiff or awkward',
    'Moves are fluent, never awkward',
  ),
  item(
    'Knowledge of instruments',
    'Often asks for or takes the wrong instrument',
    'Knows most instruments and takes the right one',
    'Knows the instruments and their names without doubt',
  ),
  item(
    'Use of assistance',
    'Hardly uses assistants, or badly',
    'Uses assistants well most of the time',
    'Uses assistants to the best all the time',
  ),
  item(
    'Flow and planning',
    'Often stops, or does not know the next step',
    'Plans ahead, the steps follow each other steadily',
    'The course is planned; one step leads to the next without effort',
  ),
  item(
    'Knowledge of this procedure',
    'Does not know enough; needs instruction at most steps',
    'Knows all that matters of the operation',
    'Is at home with every aspect of the operation',
  ),
];
