// @vitest-environment node
import { readdirSync, readFileSync } from 'node:fs';
import { join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { describe, expect, it } from 'vitest';
import {
  bareWords,
  bareWordsIn,
  catalogueParts,
  duplicates,
  faultOf,
  faults,
  kFromServer,
  kTranslations,
  pageSentences,
  sentencesIn,
} from './messages';
import translated from './translated.json';

const whole = (language: (typeof kTranslations)[number]) => Object.assign({}, ...catalogueParts(language).values());
const ofPages = (language: (typeof kTranslations)[number]) =>
  Object.assign({}, ...[...catalogueParts(language)].filter(([part]) => part !== kFromServer).map(([, part]) => part));

describe.each(kTranslations)('the catalogue %s', (language) => {
  it('has a sound translation of every sentence of the pages, and no other', () => {
    const said = pageSentences();
    expect(said.size).toBeGreaterThan(200);
    expect(faults(said, ofPages(language))).toEqual([]);
  }, 60_000); // it reads all sources

  it('has each sentence in one part alone', () => {
    expect(duplicates(catalogueParts(language))).toEqual([]);
  });

  it('writes as in Switzerland', () => {
    for (const text of Object.values(whole(language))) expect(text).not.toMatch(/ß|„|“|"/);
  });
});

it('what is translated of the server’s and the station’s words stands in their sources, in every language', () => {
  const root = fileURLToPath(new URL('../../../', import.meta.url));
  const sources = ['shared/metrics', 'shared/effects', 'shared/assessment/methods', 'server', 'station', 'db']
    .flatMap((folder) =>
      readdirSync(join(root, folder), { recursive: true, encoding: 'utf8' })
        .filter((name) => name.endsWith('.cpp') && !name.endsWith('_test.cpp'))
        .map((name) => readFileSync(join(root, folder, name), 'utf8')),
    )
    .join('\n')
    .replace(/"\s*\n\s*"/g, ''); // a long sentence stands on two lines
  const [first = [], ...others] = kTranslations.map((one) => Object.keys(catalogueParts(one).get(kFromServer) ?? {}));
  expect(first.length).toBeGreaterThan(20);
  for (const keys of others) expect(keys).toEqual(first);
  expect(first.filter((sentence) => !sources.includes(JSON.stringify(sentence)))).toEqual([]);
});

it('every language has the same parts', () => {
  const [first, ...others] = kTranslations.map((language) => [...catalogueParts(language).keys()]);
  for (const parts of others) expect(parts).toEqual(first);
});

it('the folders that are translated have no words that no catalogue has', () => {
  expect(translated.flatMap(bareWords)).toEqual([]);
});

describe('a sentence is found', () => {
  it('where it is said, marked, or has parts that are more than text', () => {
    const source = `const a = say('One {n}', { n }); const b = [marked('Two')]; say(b[0]);
      const c = <Sentence text="Go to <link>three</link>" parts={{}} />;`;
    expect(sentencesIn('a.tsx', source)).toEqual(['One {n}', 'Two', 'Go to <link>three</link>']);
  });

  it('as bare words between tags and in what is read out', () => {
    const source = `<p title="Help">{say('Said')} Bare words <code>names stay</code> {n} – Tractus</p>`;
    expect(bareWordsIn('a.tsx', source)).toEqual(['Help', 'Bare words']);
  });
});

describe('a translation is refused', () => {
  it('that is missing or empty', () => {
    expect(faultOf('Sign in', undefined)).toBe('is missing');
    expect(faultOf('Sign in', ' ')).toContain('is empty');
    expect(faults(new Map([['Sign in', 'a.tsx']]), {})).toEqual(['a.tsx: "Sign in" is missing']);
  });

  it('that lacks a placeholder, has another, or changes its name', () => {
    expect(faultOf('{n} of {all}', '{n} von')).toBe('is filled in with "n" in place of "all n"');
    expect(faultOf('Depth', 'Tiefe {m}')).toContain('is filled in with "m"');
    expect(faultOf('Go to <link>it</link>', 'Weiter')).toContain('in place of "<link>"');
    expect(faultOf('{n} of {all}', '{all}: {n}')).toBeUndefined();
  });

  it('that is no ICU message, or has a plural without its forms', () => {
    expect(faultOf('{n} trials', '{n Versuche')).toContain('cannot be read');
    expect(faultOf('{n, plural, one {# trial} other {# trials}}', '{n, plural, other {# Versuche}}')).toContain(
      '"one"',
    );
  });

  it('of a sentence that nobody says', () => {
    expect(faults(new Map(), { 'Sign in': 'Anmelden' })).toEqual(['"Sign in" is said nowhere']);
  });

  it('that two parts give', () => {
    const part = { Back: 'Zurück' };
    expect(
      duplicates(
        new Map([
          ['a.json', part],
          ['b.json', part],
        ]),
      ),
    ).toEqual(['Back: in a.json and b.json']);
  });
});

it('the glossary has each of its words in every language', () => {
  const lines = readFileSync(new URL('../../src/language/messages/README.md', import.meta.url), 'utf8').split('\n');
  const rows = lines
    .filter((line) => /^\| /.test(line))
    .map((line) =>
      line
        .split('|')
        .slice(1, -1)
        .map((cell) => cell.trim()),
    );
  expect(rows.length).toBeGreaterThan(20);
  for (const row of rows)
    expect(
      row.slice(0, 3).every((cell) => cell !== ''),
      row.join(' '),
    ).toBe(true);
});
