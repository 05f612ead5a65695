/** Dates as a person types them: in the time zone of who reads. */
import { say } from '@/language';
const two = (value: number) => String(value).padStart(2, '0');

/** "2026-03-01T12:00", for a field of date and time. */
export function toField(utc_us: number | null): string {
  if (utc_us === null) return '';
  const at = new Date(utc_us / 1000);
  return `${at.getFullYear()}-${two(at.getMonth() + 1)}-${two(at.getDate())}T${two(at.getHours())}:${two(at.getMinutes())}`;
}

/** Why a due date cannot be set; empty if it can, as it can be left out. */
export function dueProblem(text: string, now_us: number): string {
  const due = fromField(text);
  if (text !== '' && due === null) return say('Enter a date and a time.');
  return due !== null && due < now_us ? say('The due date is in the past.') : '';
}

/** null for an empty field or no date. */
export function fromField(text: string): number | null {
  const at = text === '' ? Number.NaN : new Date(text).getTime();
  return Number.isFinite(at) ? at * 1000 : null;
}
