import { describe, expect, it } from 'vitest';
import { formatBytes, utcMicroseconds } from '@/units';
import { calibrationLabel } from './labels';

const kNow = Date.UTC(2026, 10, 21) * 1000,
  kDay_us = 86_400_000_000;
const dueIn = (days: number) => calibrationLabel(utcMicroseconds(kNow + days * kDay_us), kNow);

describe('a calibration', () => {
  it('is overdue from the day after, due within two weeks, and else only dated', () => {
    expect(dueIn(-1)).toMatchObject({ tone: 'bad' });
    expect(dueIn(-1).text).toContain('overdue since');
    expect(dueIn(1)).toEqual({ tone: 'warn', text: 'due in 1 day' });
    expect(dueIn(14)).toEqual({ tone: 'warn', text: 'due in 14 days' });
    expect(dueIn(15)).toMatchObject({ tone: 'good' });
  });

  it('is not called due where the station has not reported one', () => {
    expect(calibrationLabel(null, kNow)).toEqual({ tone: 'neutral', text: 'not reported yet' });
  });
});

describe('a size', () => {
  it.each([
    [0, '0 B'],
    [999, '999 B'],
    [1000, '1.00 kB'],
    [81_000_000_000, '81.0 GB'],
    [1_240_000_000, '1.24 GB'],
    [640_000_000, '640 MB'],
  ])('%d reads %s', (bytes, text) => {
    expect(formatBytes(bytes).replaceAll('\u202f', ' ')).toBe(text);
  });
});
