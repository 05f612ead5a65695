/** How the language that is spoken writes a number that is rounded already, and a date. */
import { language, locale } from '@/language';

export const kNarrowSpace = '\u202f'; // no line break between a number and its unit

interface Marks {
  readonly decimal: string;
  readonly group: string;
}

/** English as the SI brochure has it: a point, and groups of three apart by a narrow space. */
const kEnglish: Marks = { decimal: '.', group: kNarrowSpace };
const kMarks = new Map<string, Marks>();

/** The marks of a Swiss locale, as the browser knows them: 12’345.6 in German, 12 345,6 in French. */
function marks(): Marks {
  if (language() === 'en') return kEnglish;
  const of = locale();
  const known = kMarks.get(of);
  if (known) return known;
  const parts = new Intl.NumberFormat(of).formatToParts(1234567.8);
  const mark = (type: 'decimal' | 'group') => parts.find((part) => part.type === type)?.value ?? kEnglish[type];
  const found = { decimal: mark('decimal'), group: mark('group') };
  kMarks.set(of, found);
  return found;
}

/** The mark before the decimals. */
export const decimalMark = (): string => marks().decimal;

/** "12345.6", as JavaScript writes it, as a person reads it: grouped from five digits on. */
export function written(plain: string): string {
  const [whole = '', fraction] = plain.split('.');
  const { decimal, group } = marks();
  const grouped = whole.length > 4 ? whole.replace(/\B(?=(\d{3})+$)/g, group) : whole;
  return fraction === undefined ? grouped : grouped + decimal + fraction;
}

/** A date in the reader's own time zone, with one format for each language. */
export function dateWriter(options: Intl.DateTimeFormatOptions): (utc_us: number) => string {
  const formats = new Map<string, Intl.DateTimeFormat>();
  return (utc_us) => {
    const of = locale();
    const format = formats.get(of) ?? new Intl.DateTimeFormat(of, options);
    formats.set(of, format);
    return format.format(new Date(utc_us / 1000));
  };
}
