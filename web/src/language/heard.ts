/** Sentences that a server or a station wrote, with figures in them: recognised by their pattern, said in the language that is spoken. */
import { language, say, translated, type Values } from './language';

interface Pattern {
  readonly english: string;
  readonly expression: RegExp;
}

const escaped = (text: string) => text.replace(/[.*+?^$()|[\]\\]/g, '\\$&');

/** `english` has {name} where the sentence has a figure or a word, which never holds what divides clauses. */
function patternOf(english: string): Pattern {
  const expression = escaped(english).replace(/\{(\w+)\}/g, (_, name: string) => `(?<${name}>(?:(?!: ).)+?)`);
  return { english, expression: new RegExp(`^${expression}$`) };
}

/** Reads what was put together: clauses by `; `, what is asked and what was found by `: `. A clause that no pattern fits stays as it is. */
export function hearing(patterns: readonly string[]): (english: string) => string {
  const all = patterns.map(patternOf);
  const one = (english: string): string => {
    for (const { english: pattern, expression } of all) {
      const groups = expression.exec(english)?.groups;
      if (groups) return say(pattern, wordsIn(groups));
      if (pattern === english) return say(pattern);
    }
    const at = english.lastIndexOf(': ');
    return at < 0 ? translated(english) : `${one(english.slice(0, at))}: ${one(english.slice(at + 2))}`;
  };
  return (english) => (language() === 'en' ? english : english.split('; ').map(one).join('; '));
}

const wordsIn = (groups: Readonly<Record<string, string>>): Values =>
  Object.fromEntries(Object.entries(groups).map(([name, text]) => [name, translated(text)]));
