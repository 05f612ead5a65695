/** Dates of a date field, in the time zone of this computer. */

const kDay_ms = 86_400_000;

/** "2027-02-22": so many days from now. */
export function dateText(days: number, now_ms = Date.now()): string {
  const date = new Date(now_ms + days * kDay_ms);
  const two = (value: number) => `${value}`.padStart(2, '0');
  return `${date.getFullYear()}-${two(date.getMonth() + 1)}-${two(date.getDate())}`;
}

/** The end of the day: a token is valid on the whole day. */
export const endOfDay_utc_us = (date: string) => new Date(`${date}T23:59:59`).getTime() * 1000;
