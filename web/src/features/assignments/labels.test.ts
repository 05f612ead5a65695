import { describe, expect, it } from 'vitest';
import { utcMicroseconds } from '@/units';
import { fromField, toField } from './dates';
import { drillingLabel, dueState } from './labels';

const now = Date.UTC(2026, 2, 10, 12) * 1000;
const day_us = 24 * 3600 * 1e6;
const due = (days: number | null, done = 0) => ({
  due_utc_us: days === null ? null : utcMicroseconds(now + days * day_us),
  done,
  planned: 4,
});

describe('what is due', () => {
  it('is late once its date has passed, and no longer when all is done', () => {
    expect(dueState(due(-1), now)).toBe('late');
    expect(dueState(due(-1, 4), now)).toBe('none');
  });
  it('is soon within three days', () => {
    expect(dueState(due(2), now)).toBe('soon');
    expect(dueState(due(4), now)).toBe('later');
  });
  it('is nothing without a date', () => {
    expect(dueState(due(null), now)).toBe('none');
  });
  it('is read from the field to the minute that was written into it', () => {
    const at = Date.UTC(2026, 6, 1, 8, 30) * 1000;
    expect(fromField(toField(at))).toBe(at);
    expect(fromField('')).toBeNull();
    expect(fromField('soon')).toBeNull();
  });
});

describe('what is drilled', () => {
  it('is said of all, of some, and not at all of none', () => {
    expect(drillingLabel({ to_drill: 2, planned: 2 })).toBe('drill, then palpate');
    expect(drillingLabel({ to_drill: 1, planned: 4 })).toBe('1 of 4: drill, then palpate');
    expect(drillingLabel({ to_drill: 0, planned: 4 })).toBe('');
  });
});
