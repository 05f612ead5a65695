/** A rubric as it is being written. Pure. */
import type { RubricItem } from '@/api';
import { marked, say } from '@/language';
import { formatCount } from '@/units';

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
  if (of.label.trim() === '') return say('Name the item.');
  const low = whole(of.low),
    high = whole(of.high);
  if (!(low >= 0 && high <= kLargestPoint))
    return say('Points from 0 to {most} are expected.', { most: formatCount(kLargestPoint) });
  if (!(high > low)) return say('The high end must have more points than the low end.');
  if (of.low_text.trim() === '' || of.high_text.trim() === '') return say('Describe both ends.');
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

/** The seven items of OSATS' global rating scale [Martin1997], described in our own words; in English. */
const kGlobalRating: readonly Partial<RubricItem>[] = [
  item(
    marked('Respect for tissue'),
    marked('Often uses more force than needed, or harms tissue by careless handling'),
    marked('Handles tissue carefully, with a slip now and then'),
    marked('Handles tissue carefully throughout and harms it as little as can be'),
  ),
  item(
    marked('Time and motion'),
    marked('Makes many needless moves'),
    marked('Efficient, with some needless moves'),
    marked('No needless move'),
  ),
  item(
    marked('Handling of instruments'),
    marked('Moves are hesitant or awkward'),
    marked('Competent, at times stiff or awkward'),
    marked('Moves are fluent, never awkward'),
  ),
  item(
    marked('Knowledge of instruments'),
    marked('Often asks for or takes the wrong instrument'),
    marked('Knows most instruments and takes the right one'),
    marked('Knows the instruments and their names without doubt'),
  ),
  item(
    marked('Use of assistance'),
    marked('Hardly uses assistants, or badly'),
    marked('Uses assistants well most of the time'),
    marked('Uses assistants to the best all the time'),
  ),
  item(
    marked('Flow and planning'),
    marked('Often stops, or does not know the next step'),
    marked('Plans ahead, the steps follow each other steadily'),
    marked('The course is planned; one step leads to the next without effort'),
  ),
  item(
    marked('Knowledge of this procedure'),
    marked('Does not know enough; needs instruction at most steps'),
    marked('Knows all that matters of the operation'),
    marked('Is at home with every aspect of the operation'),
  ),
];

/** The global rating scale in the reader's language. */
export const globalRating = (): readonly Partial<RubricItem>[] =>
  kGlobalRating.map(({ label = '', low_text = '', middle_text = '', high_text = '' }) =>
    item(say(label), say(low_text), say(middle_text), say(high_text)),
  );
