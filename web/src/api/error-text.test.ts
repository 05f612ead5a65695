import { afterEach, describe, expect, it } from 'vitest';
import { speak } from '@/language';
import { speakFrom } from '@/language/language';
import { errorText } from './error-text';

afterEach(() => speak('en'));

describe('an error of the server', () => {
  it('is shown in English as it came', () => {
    expect(errorText('conflict', 'another backup is being made or verified')).toBe(
      'another backup is being made or verified',
    );
  });

  it('is shown in German by its code, with the server’s own words as detail', async () => {
    await speak('de');
    expect(errorText('forbidden', 'only {x} may')).toBe('Sie dürfen das nicht: only {x} may');
    expect(errorText('forbidden', 'only {x} may')).not.toBe(errorText('conflict', 'only {x} may'));
  });

  it('is shown by its sentence where the catalogue has it', () => {
    speakFrom('fr', { 'the account is disabled': 'le compte est désactivé' });
    expect(errorText('unauthorised', 'the account is disabled')).toBe('le compte est désactivé');
  });

  it('of a code that is not known here is shown as it came', async () => {
    await speak('fr');
    expect(errorText('toString', 'something new')).toBe('something new');
    expect(errorText('brand_new', 'something new')).toBe('something new');
  });
});
