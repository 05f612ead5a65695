/** What the pages say: read from the sources by TypeScript's own parser, and compared with the catalogues of other languages. */
import { parse, TYPE, type MessageFormatElement } from '@formatjs/icu-messageformat-parser';
import { existsSync, readdirSync, readFileSync } from 'node:fs';
import { join, relative } from 'node:path';
import { fileURLToPath } from 'node:url';
import ts from 'typescript';

const kSources = fileURLToPath(new URL('../../src/', import.meta.url));
const kMessages = join(kSources, 'language/messages');
export const kTranslations = ['de', 'fr'] as const;
export type Translation = (typeof kTranslations)[number];
export type Catalogue = Readonly<Record<string, string>>;

/** Sentences of the server's and the station's that pages translate when they arrive: no page has them. */
export const kFromServer = 'server.json';

function sourceFiles(folder = kSources): string[] {
  return readdirSync(folder, { recursive: true, encoding: 'utf8' })
    .filter((name) => /\.tsx?$/.test(name) && !name.includes('.test.') && !name.startsWith('api/generated'))
    .map((name) => join(folder, name));
}

const parsed = (file: string, text: string) =>
  ts.createSourceFile(
    file,
    text,
    ts.ScriptTarget.Latest,
    true,
    file.endsWith('x') ? ts.ScriptKind.TSX : ts.ScriptKind.TS,
  );

function textOf(node: ts.Node | undefined): string | undefined {
  return node !== undefined && ts.isStringLiteralLike(node) ? node.text : undefined;
}

/** The sentence that a node says or marks. */
function sentenceOf(node: ts.Node): string | undefined {
  if (ts.isCallExpression(node) && ['say', 'marked'].includes(node.expression.getText()))
    return textOf(node.arguments[0]);
  const tag = ts.isJsxSelfClosingElement(node) ? node : undefined;
  if (tag?.tagName.getText() !== 'Sentence') return undefined;
  const [found] = tag.attributes.properties.filter((one) => ts.isJsxAttribute(one) && one.name.getText() === 'text');
  const value = found && ts.isJsxAttribute(found) ? found.initializer : undefined;
  return textOf(value && ts.isJsxExpression(value) ? value.expression : value);
}

/** Every sentence of a source. */
export function sentencesIn(file: string, text: string): string[] {
  const found: string[] = [];
  const visit = (node: ts.Node) => {
    const sentence = sentenceOf(node);
    if (sentence !== undefined) found.push(sentence);
    ts.forEachChild(node, visit);
  };
  visit(parsed(file, text));
  return found;
}

/** Every sentence of the pages, with the file that says it first. */
export function pageSentences(): Map<string, string> {
  const all = new Map<string, string>();
  for (const file of sourceFiles())
    for (const sentence of sentencesIn(file, readFileSync(file, 'utf8')))
      if (!all.has(sentence)) all.set(sentence, relative(kSources, file));
  return all;
}

const hasWords = (text: string) => /\p{L}{2}/u.test(text.replaceAll('Tractus', ''));
const kSpoken = /^(?:aria-label|alt|caption|empty|hint|label|legend|placeholder|title)$/;

/** Words of a source that a person reads and that no catalogue can translate: text between tags, and what is read out. */
export function bareWordsIn(file: string, text: string): string[] {
  const found: string[] = [];
  const visit = (node: ts.Node) => {
    if (ts.isJsxElement(node) && node.openingElement.tagName.getText() === 'code') return;
    if (ts.isJsxText(node) && hasWords(node.text)) found.push(node.text.trim().replace(/\s+/g, ' '));
    if (ts.isJsxAttribute(node) && kSpoken.test(node.name.getText())) {
      const words = textOf(node.initializer);
      if (words !== undefined && hasWords(words)) found.push(words);
    }
    ts.forEachChild(node, visit);
  };
  visit(parsed(file, text));
  return found;
}

/** The bare words of a folder or file of the sources. */
export function bareWords(place: string): string[] {
  const files = /\.tsx?$/.test(place) ? [join(kSources, place)] : sourceFiles(join(kSources, place));
  return files.flatMap((file) =>
    bareWordsIn(file, readFileSync(file, 'utf8')).map((words) => `${relative(kSources, file)}: ${words}`),
  );
}

/** The parts of a language's catalogue: a file for each folder of the pages. */
export function catalogueParts(language: Translation): Map<string, Catalogue> {
  const folder = join(kMessages, language);
  const names = existsSync(folder) ? readdirSync(folder).sort() : [];
  return new Map(names.map((name) => [name, JSON.parse(readFileSync(join(folder, name), 'utf8')) as Catalogue]));
}

/** A sentence that two parts have would be translated by whichever comes last. */
export function duplicates(parts: ReadonlyMap<string, Catalogue>): string[] {
  const seen = new Map<string, string>();
  const found: string[] = [];
  for (const [part, catalogue] of parts)
    for (const sentence of Object.keys(catalogue)) {
      const other = seen.get(sentence);
      if (other !== undefined) found.push(`${sentence}: in ${other} and ${part}`);
      seen.set(sentence, part);
    }
  return found;
}

/** The names that a message is filled in with, tags, and the forms of each plural. */
function shapeOf(elements: readonly MessageFormatElement[], names = new Set<string>(), forms: string[][] = []) {
  for (const element of elements) {
    if (element.type === TYPE.argument) names.add(element.value);
    if (element.type === TYPE.tag) {
      names.add(`<${element.value}>`);
      shapeOf(element.children, names, forms);
    }
    if (element.type === TYPE.plural || element.type === TYPE.select) {
      names.add(element.value);
      if (element.type === TYPE.plural) forms.push(Object.keys(element.options));
      for (const { value } of Object.values(element.options)) shapeOf(value, names, forms);
    }
  }
  return { names, forms };
}

const isFilledIn = (text: string) => /[{}]|<\/?\w/.test(text);

function shape(text: string): { names: string; forms: string[][] } | string {
  if (!isFilledIn(text)) return { names: '', forms: [] };
  try {
    const { names, forms } = shapeOf(parse(text));
    return { names: [...names].sort().join(' '), forms };
  } catch (reason) {
    return reason instanceof Error ? reason.message : String(reason);
  }
}

/** What is wrong with a translation, in words; undefined: nothing. */
export function faultOf(english: string, translation: string | undefined): string | undefined {
  if (translation === undefined) return 'is missing';
  if (translation.trim() === '' || translation.trim() !== translation) return 'is empty or begins or ends with a space';
  const mine = shape(translation),
    theirs = shape(english);
  if (typeof mine === 'string') return `cannot be read: ${mine}`;
  if (typeof theirs === 'string') return `translates a sentence that cannot be read: ${theirs}`;
  if (mine.names !== theirs.names) return `is filled in with "${mine.names}" in place of "${theirs.names}"`;
  return mine.forms.every((forms) => forms.includes('one') && forms.includes('other'))
    ? undefined
    : 'has a plural without "one" or "other"';
}

/** Every fault of a catalogue as a line: missing, unused and wrong translations. */
export function faults(sentences: ReadonlyMap<string, string>, catalogue: Catalogue): string[] {
  const wrong = [...sentences].flatMap(([english, file]) => {
    const fault = faultOf(english, catalogue[english]);
    return fault === undefined ? [] : [`${file}: "${english}" ${fault}`];
  });
  const unused = Object.keys(catalogue).filter((english) => !sentences.has(english));
  return [...wrong, ...unused.map((english) => `"${english}" is said nowhere`)];
}
