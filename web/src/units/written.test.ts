import { afterEach, beforeEach, describe, expect, it } from 'vitest';
import { speak } from '@/language';
import {
  digits,
  formatBytes,
  formatClock,
  formatCount,
  formatDate,
  formatDateTime,
  formatForce,
  formatLength,
  formatRate,
  formatScore,
  formatShare,
  formatYears,
  kTorque,
  metre,
  newton,
  share,
  shownValue,
  tickLabels,
  utcMicroseconds,
} from '@/units';

// Expected: the Swiss Confederation's rules for writing, German (decimal point, apostrophe) and French (decimal comma, narrow space).
const plain = (text: string) => text.replaceAll(/[\u202f\u00a0]/g, ' ');
const noon = utcMicroseconds(Date.UTC(2025, 10, 21, 12, 5, 7) * 1000);

afterEach(() => speak('en'));

describe('in German as in Switzerland', () => {
  beforeEach(() => speak('de'));

  it('a number has a point, and apostrophes from five digits on', () => {
    expect(plain(formatForce(newton(7.78)))).toBe('7.78 N');
    expect(formatCount(240000)).toMatch(/^240['’]000$/); // CLDR has changed the apostrophe once
    expect(formatCount(4000)).toBe('4000');
    expect(plain(formatShare(share(0.00005), 3))).toBe('0.005 %');
  });

  it('a date has its day, its month’s name and its year in German', () => {
    expect(formatDate(noon)).toMatch(/^21\.(11\.2025| (Nov\.|November) 2025)$/);
    expect(formatClock(noon)).toMatch(/^21\. Nov/);
  });

  it('words beside numbers are German', () => {
    expect(plain(formatYears(1))).toBe('1 Jahr');
    expect(plain(formatYears(6))).toBe('6 Jahre');
    expect(formatScore({ value: 1, unit: '1', shown_as: 'correct_or_incorrect' })).toBe('richtig');
  });
});

describe('in French as in Switzerland', () => {
  beforeEach(() => speak('fr'));

  it('a number has a comma, and narrow spaces from five digits on', () => {
    expect(plain(formatForce(newton(-1.5)))).toBe('−1,50 N');
    expect(plain(formatLength(metre(0.0094)))).toBe('9,4 mm');
    expect(plain(formatCount(240000))).toBe('240 000');
    expect(plain(digits(0.0004, kTorque))).toBe('< 0,001');
    expect(plain(formatShare(share(0.999)))).toBe('> 99 %');
    expect(plain(formatRate(1500))).toBe('1,5 kHz');
    expect(plain(formatBytes(1.24e9))).toBe('1,24 GB');
    expect(tickLabels([-0.05, 0, 0.05], 0.05)).toEqual(['−0,05', '0,00', '0,05']);
    expect(plain(formatYears(0.33))).toBe('0,33 an');
  });

  it('a date has its month in French', () => {
    expect(formatDateTime(noon)).toContain('2025');
    expect(formatClock(noon)).toMatch(/^21 nov/);
  });

  it('a place on an axis stays a number', () => {
    expect(shownValue(0.0094, 'm')).toBeCloseTo(9.4, 9);
    expect(shownValue(0.5, 'unknown')).toBe(0.5);
  });
});

it('a change of the language changes the next number, back and forth', async () => {
  await speak('fr');
  expect(plain(formatForce(newton(1.5)))).toBe('1,50 N');
  await speak('en');
  expect(plain(formatForce(newton(1.5)))).toBe('1.50 N');
  expect(plain(formatCount(240000))).toBe('240 000');
});
