/** Dates as a person types them: in the time zone of who reads. */
const two = (value: number) => String(value).padStart(2, '0');

/** "2026-03-01T12:00", for a field of date and time. */
export function toField(utc_us: number | null): string {
  if (utc_us === null) return '';
  const at = new Date(utc_us / 1000);
  return `${at.getFullYear()}-${two(at.getMonth() + 1)}-${two(at.getDate())}T${two(at.getHours())}:${two(at.getMinutes())}`;
}

/** null for an empty field or no date. */
export function fromField(text: string): number | null {
  const at = text === '' ? Number.NaN : new Date(text).getTime();
  return Number.isFinite(at) ? at * 1000 : null;
}
