import { afterEach, expect, it } from 'vitest';
import { catalogue } from './german';
import { hearing, marked } from '.';
import { speakFrom } from './language';

const heard = hearing([
  marked('no answer yet'),
  marked('{metric} at most {bound} in {times} of trials'),
  marked('{kept} of {count}'),
]);
afterEach(() => {
  speakFrom('en', {});
});

it('leaves what a server wrote as it is in English', () => {
  expect(heard('Probing time at most 45 s in 1 of trials')).toBe('Probing time at most 45 s in 1 of trials');
});

it('says figures and words of a sentence in the language that is spoken, clause by clause', () => {
  speakFrom('de', catalogue);
  expect(heard('Probing time at most 45 s in 1 of trials')).toBe('Sondierzeit höchstens 45 s in 1 der Versuche');
  expect(heard('Probing time at most 45 s in 1 of trials: 2 of 3; no answer yet')).toBe(
    'Sondierzeit höchstens 45 s in 1 der Versuche: 2 von 3; noch keine Antwort',
  );
});

it('leaves a sentence that it does not know', () => {
  speakFrom('de', catalogue);
  expect(heard('Something else entirely')).toBe('Something else entirely');
});
