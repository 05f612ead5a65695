/** The language of the pages: the English sentence is the key; a catalogue of another language has its translation. */
import { IntlMessageFormat } from 'intl-messageformat';

export const kLanguages = ['en', 'de', 'fr'] as const;
export type Language = (typeof kLanguages)[number];

/** How each language names itself. */
export const kLanguageNames: Readonly<Record<Language, string>> = { en: 'English', de: 'Deutsch', fr: 'Français' };
/** By whose conventions dates and numbers are written: German and French as in Switzerland. */
export const kLocales: Readonly<Record<Language, string>> = { en: 'en-GB', de: 'de-CH', fr: 'fr-CH' };

export type Catalogue = Readonly<Record<string, string | undefined>>;
export type Values = Readonly<Record<string, string | number>>;

/** A catalogue comes when its language is chosen first; English needs none. */
const kCatalogues: Readonly<Record<Language, () => Promise<Catalogue>>> = {
  en: () => Promise.resolve({}),
  de: () => import('./german').then(({ catalogue }) => catalogue),
  fr: () => import('./french').then(({ catalogue }) => catalogue),
};

let spoken: { readonly language: Language; readonly catalogue: Catalogue } = { language: 'en', catalogue: {} };
let wanted: Language = 'en';
const listeners = new Set<() => void>();
const formats = new Map<string, IntlMessageFormat>();

export const language = (): Language => spoken.language;
export const locale = (): string => kLocales[spoken.language];

export function onLanguage(listener: () => void): () => void {
  listeners.add(listener);
  return () => listeners.delete(listener);
}

/** Sets the language as soon as its catalogue is there; one that does not come leaves the pages as they are. */
export async function speak(chosen: Language): Promise<void> {
  wanted = chosen;
  const catalogue = await kCatalogues[chosen]();
  if (wanted !== chosen) return; // another was chosen meanwhile
  speakFrom(chosen, catalogue);
}

/** Sets the language with a catalogue that is here already. */
export function speakFrom(chosen: Language, catalogue: Catalogue): void {
  wanted = chosen;
  spoken = { language: chosen, catalogue };
  formats.clear();
  if (typeof document !== 'undefined') document.documentElement.lang = chosen;
  for (const listener of listeners) listener();
}

/** Marks a sentence for translation where it stands in a table; `say` translates it when it is shown. */
export const marked = <Text extends string>(english: Text): Text => english;

/** The sentence that is shown for an English one, not filled in yet. */
export const translated = (english: string): string => spoken.catalogue[english] ?? english;

function formatOf(text: string, of: string, ignoreTag: boolean): IntlMessageFormat {
  const key = `${of} ${String(ignoreTag)} ${text}`;
  const known = formats.get(key);
  if (known) return known;
  const made = new IntlMessageFormat(text, of, undefined, { ignoreTag });
  formats.set(key, made);
  return made;
}

/** Fills in the translation; one that cannot be filled in gives way to the English sentence. */
export function filled<Result>(english: string, fill: (format: IntlMessageFormat) => Result, ignoreTag = true): Result {
  const text = translated(english);
  if (text !== english) {
    try {
      return fill(formatOf(text, locale(), ignoreTag));
    } catch {
      // The catalogue's test tells of it; whoever reads the page gets the sentence all the same.
    }
  }
  return fill(formatOf(english, kLocales.en, ignoreTag));
}

/** An English sentence in the language that is spoken. Values stand in it as {name}, plurals as ICU writes them. */
export function say(english: string, values?: Values): string {
  if (values === undefined) return translated(english);
  return filled(english, (format) => String(format.format(values)));
}
