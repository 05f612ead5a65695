/** Words of the pages in the language that a test reads them in: an English sentence is given, what stands on the page comes back. */
import { IntlMessageFormat } from 'intl-messageformat';
import { catalogue as german } from '../../src/language/german';
import { kLocales, type Values } from '../../src/language/language';

export type TestedLanguage = 'en' | 'de';

export class Words {
  constructor(readonly language: TestedLanguage) {}

  /** What a browser of that language asks for. */
  get locale(): string {
    return kLocales[this.language];
  }
  /** The whole sentence. @throws Error if it is in no catalogue */
  said = (english: string, values: Values = {}): string => {
    const text = this.language === 'en' ? english : german[english];
    if (text === undefined) throw new Error(`no translation: ${english}`);
    return String(new IntlMessageFormat(text, this.locale, undefined, { ignoreTag: true }).format(values));
  };
  /** What matches the sentence with anything in place of a value that is not given. */
  like = (english: string, values: Values = {}): RegExp => {
    const open = Object.fromEntries([...english.matchAll(/\{(\w+)/g)].map(([, name = '']) => [name, '\u0000']));
    const text = this.said(english, { ...open, ...values });
    return new RegExp(text.replace(/[.*+?^${}()|[\]\\]/g, '\\$&').replaceAll('\u0000', '.*'));
  };
}
