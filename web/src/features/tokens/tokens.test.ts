import { describe, expect, it } from 'vitest';
import { utcMicroseconds } from '@/units';
import { dateText, endOfDay_utc_us } from './dates';
import { tokenState } from './token-table';

const token = {
  id: 't',
  name: 'nightly',
  owner: 'rex',
  scopes: ['trials:read'],
  made_utc_us: utcMicroseconds(0),
  expires_utc_us: utcMicroseconds(2_000_000),
  used_utc_us: null,
  revoked_utc_us: null,
  revoked_by: null,
};

describe('a token', () => {
  it('is valid until its time, and not at it', () => {
    expect(tokenState(token, 1_999_999).tone).toBe('good');
    expect(tokenState(token, 2_000_000).text).toMatch(/^expired/);
  });
  it('that was revoked says by whom', () => {
    const revoked = { ...token, revoked_utc_us: utcMicroseconds(1), revoked_by: 'ann' };
    expect(tokenState(revoked, 0).text).toMatch(/^revoked .* by ann$/);
  });
});

describe('a date', () => {
  it('counts days from now over the end of a month', () => {
    expect(dateText(1, new Date(2026, 10, 30, 12).getTime())).toBe('2026-12-01');
  });
  it('lasts until its end', () => {
    expect(endOfDay_utc_us('2026-12-01')).toBe(new Date(2026, 11, 1, 23, 59, 59).getTime() * 1000);
  });
});
