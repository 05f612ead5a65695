import { render, screen } from '@testing-library/react';
import { afterEach, describe, expect, it } from 'vitest';
import { speakFrom } from './language';
import {
  chooseLanguage,
  kLanguages,
  language,
  locale,
  onLanguage,
  preferredLanguage,
  readLanguage,
  say,
  Sentence,
  speak,
} from '.';

afterEach(() => {
  localStorage.clear();
  speakFrom('en', {});
});

describe('the language of a person', () => {
  it('is the first of the browser that is here', () => {
    expect(preferredLanguage(['it-CH', 'fr-CH', 'de'])).toBe('fr');
    expect(preferredLanguage(['de_AT'])).toBe('de');
    expect(preferredLanguage(['en-US', 'de'])).toBe('en');
  });

  it('is English where no language of the browser is here, or it names none', () => {
    expect(preferredLanguage(['rm', 'it-CH', 'zz-invalid', ''])).toBe('en');
    expect(preferredLanguage([])).toBe('en');
    expect(readLanguage('den')).toBeUndefined();
    expect(readLanguage(null)).toBeUndefined();
  });

  it('is the one that was chosen, before the browser’s', async () => {
    await chooseLanguage('fr');
    expect(preferredLanguage(['de-CH'])).toBe('fr');
    localStorage.setItem('tractus-language', 'xx');
    expect(preferredLanguage(['de-CH'])).toBe('de');
  });

  it('is told to the document and to whoever listens', async () => {
    const heard: string[] = [];
    const end = onLanguage(() => heard.push(language()));
    await speak('de');
    expect(document.documentElement.lang).toBe('de');
    expect(locale()).toBe('de-CH');
    end();
    await speak('en');
    expect(document.documentElement.lang).toBe('en');
    expect(heard).toEqual(['de']);
  });

  it('is the last that was chosen, whichever catalogue comes first', async () => {
    await Promise.all([speak('de'), speak('fr'), speak('en')]);
    expect(language()).toBe('en');
  });
});

describe('a sentence', () => {
  it.each(kLanguages)('of the sign-in is said in %s from its own catalogue', async (one) => {
    await speak(one);
    expect(say('Sign in')).toBe({ en: 'Sign in', de: 'Anmelden', fr: 'Se connecter' }[one]);
  });

  it('that the catalogue lacks is said in English', () => {
    speakFrom('de', {});
    expect(say('Sign in')).toBe('Sign in');
    expect(say('{n, plural, one {# trial} other {# trials}}', { n: 2 })).toBe('2 trials');
  });

  it('whose translation cannot be filled in is said in English', () => {
    speakFrom('de', { '{n} trials': '{m} Versuche', 'Depth {d}': 'Tiefe {d' });
    expect(say('{n} trials', { n: 3 })).toBe('3 trials');
    expect(say('Depth {d}', { d: '9 mm' })).toBe('Depth 9 mm');
  });

  it('has the plural of its language', () => {
    const trials = '{n, plural, one {# trial} other {# trials}}';
    speakFrom('fr', { [trials]: '{n, plural, one {# essai} other {# essais}}' });
    expect(say(trials, { n: 0 })).toBe('0 essai'); // French: none is singular
    speakFrom('de', { [trials]: '{n, plural, one {# Versuch} other {# Versuche}}' });
    expect(say(trials, { n: 0 })).toBe('0 Versuche');
    expect(say(trials, { n: 1 })).toBe('1 Versuch');
  });

  it('takes what it is filled in with as text', () => {
    expect(say('{name} is here', { name: '<b>{x}</b>' })).toBe('<b>{x}</b> is here');
  });

  it('has its parts where its language wants them', () => {
    const text = 'Go to <link>the page</link> of {name}.';
    speakFrom('de', { [text]: 'Von {name} <link>zur Seite</link>.' });
    const { container } = render(
      <Sentence text={text} values={{ name: '<Ada>' }} parts={{ link: (words) => <a href="/there">{words}</a> }} />,
    );
    expect(container.textContent).toBe('Von <Ada> zur Seite.');
    expect(screen.getByRole('link', { name: 'zur Seite' })).toBeDefined();
  });
});
