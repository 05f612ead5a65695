/** The only place where a number becomes text. SI in; millimetres, degrees and per cent out. */
import { say } from '@/language';
import {
  kAngle,
  kForce,
  kLength,
  kSpeed,
  kTime,
  kTorque,
  share,
  type Metre,
  type Newton,
  type NewtonMetre,
  type Quantity,
  type Radian,
  type Second,
  type Share,
  type UtcMicroseconds,
} from './quantity';
import { dateWriter, kNarrowSpace, written } from './written';

const kMinus = '−';
export const kNone = '–';

/** Digits only, in the display unit. What is not zero but would print as zero reads "< 0.01". */
export function digits(si: number, quantity: Quantity, decimals = quantity.decimals): string {
  if (!Number.isFinite(si)) return kNone;
  const shown = si * quantity.perSi;
  const least = 10 ** -decimals;
  if (shown !== 0 && Math.abs(shown) < least / 2) {
    return shown > 0
      ? `<${kNarrowSpace}${written(least.toFixed(decimals))}`
      : `>${kNarrowSpace}${kMinus}${written(least.toFixed(decimals))}`;
  }
  return (shown < 0 ? kMinus : '') + written(Math.abs(shown).toFixed(decimals));
}

/** Digits rounded as they come: for a reading that moves, where a bound would only flicker. */
export function rounded(si: number, quantity: Quantity): string {
  if (!Number.isFinite(si)) return kNone;
  const text = Math.abs(si * quantity.perSi).toFixed(quantity.decimals);
  return (si < 0 && Number(text) !== 0 ? kMinus : '') + written(text);
}

/** "1.23 N": digits and unit. The degree sign stands without a space. */
export function withUnit(si: number, quantity: Quantity, decimals = quantity.decimals): string {
  return united(digits(si, quantity, decimals), quantity);
}

/** Puts the unit behind digits. */
export function united(text: string, quantity: Quantity): string {
  if (text === kNone) return text;
  return quantity.unit === '°' ? `${text}°` : text + kNarrowSpace + quantity.unit;
}

export const formatForce = (value: Newton) => withUnit(value, kForce);
export const formatTorque = (value: NewtonMetre) => withUnit(value, kTorque);
export const formatLength = (value: Metre, decimals = kLength.decimals) => withUnit(value, kLength, decimals);
export const formatAngle = (value: Radian) => withUnit(value, kAngle);
export const formatTime = (value: Second, decimals = kTime.decimals) => withUnit(value, kTime, decimals);

/** "42.5 s", "3 min 05 s", "1 h 02 min". */
export function formatDuration(value: Second): string {
  if (!Number.isFinite(value)) return kNone;
  if (value < 119.95) return withUnit(value, kTime, 1);
  const whole = Math.round(value);
  const two = (n: number) => String(n).padStart(2, '0');
  if (whole < 3600) return `${Math.floor(whole / 60)}${kNarrowSpace}min ${two(whole % 60)}${kNarrowSpace}s`;
  return `${Math.floor(whole / 3600)}${kNarrowSpace}h ${two(Math.floor((whole % 3600) / 60))}${kNarrowSpace}min`;
}

export function formatCount(value: number): string {
  return Number.isFinite(value) ? (value < 0 ? kMinus : '') + written(Math.abs(Math.round(value)).toFixed(0)) : kNone;
}

/** "4 of 12 steps" needs a share that is honest near 0 and 1: never "0 %" for some, never "100 %" for not all. */
export function formatShare(value: Share, decimals = 0): string {
  if (!Number.isFinite(value)) return kNone;
  const percent = value * 100;
  const least = 10 ** -decimals;
  if (percent > 0 && percent < least / 2) return `<${kNarrowSpace}${written(least.toFixed(decimals))}${kNarrowSpace}%`;
  if (percent < 100 && percent > 100 - least / 2)
    return `>${kNarrowSpace}${written((100 - least).toFixed(decimals))}${kNarrowSpace}%`;
  return `${written(percent.toFixed(decimals))}${kNarrowSpace}%`;
}

export function formatRate(hertz: number): string {
  if (!Number.isFinite(hertz)) return kNone;
  return hertz >= 1000
    ? `${written(String(Number((hertz / 1000).toFixed(3))))}${kNarrowSpace}kHz`
    : `${written(String(Number(hertz.toFixed(1))))}${kNarrowSpace}Hz`;
}

const writeDateTime = dateWriter({ dateStyle: 'medium', timeStyle: 'short' });
const writeSeconds = dateWriter({ dateStyle: 'full', timeStyle: 'long' });

const kBytes = ['B', 'kB', 'MB', 'GB', 'TB'] as const;

/** "1.24 GB": in steps of a thousand, as disks are sold. */
export function formatBytes(bytes: number): string {
  if (!Number.isFinite(bytes)) return kNone;
  const step = bytes < 1000 ? 0 : Math.min(Math.floor(Math.log10(bytes) / 3), kBytes.length - 1);
  const shown = bytes / 1000 ** step;
  const text = shown.toFixed(step === 0 || shown >= 100 ? 0 : shown >= 10 ? 1 : 2);
  return `${written(text)}${kNarrowSpace}${kBytes[step] ?? 'B'}`;
}

/** In the reader's own time zone: "21 Nov 2025, 05:35". */
export const formatDateTime = (value: UtcMicroseconds) => writeDateTime(value);
const writeDate = dateWriter({ dateStyle: 'medium' });
/** "21 Nov 2025". */
export const formatDate = (value: UtcMicroseconds) => writeDate(value);
export const formatDateTimeLong = (value: UtcMicroseconds) => writeSeconds(value);
/** The reader's own time zone, in which times are shown: "Europe/Berlin, UTC+2". */
export function timeZone(now = new Date()): string {
  const name = Intl.DateTimeFormat().resolvedOptions().timeZone;
  const ahead_min = -now.getTimezoneOffset();
  if (ahead_min === 0) return name === 'UTC' ? name : `${name}, UTC`;
  const hours = Math.floor(Math.abs(ahead_min) / 60),
    minutes = Math.abs(ahead_min) % 60;
  return `${name}, UTC${ahead_min > 0 ? '+' : kMinus}${hours}${minutes === 0 ? '' : `:${String(minutes).padStart(2, '0')}`}`;
}
export const isoDateTime = (value: UtcMicroseconds) => new Date(value / 1000).toISOString();

const writeClock = dateWriter({
  day: '2-digit',
  month: 'short',
  hour: '2-digit',
  minute: '2-digit',
  second: '2-digit',
});
/** "21 Nov, 05:35:07": for a list of what happened. */
export const formatClock = (value: UtcMicroseconds) => writeClock(value);

/** "6 years", "0.33 years", "1 year". */
export function formatYears(value: number): string {
  if (!Number.isFinite(value)) return kNone;
  const count = written(String(Number(value.toFixed(2))));
  return say('{count}\u202f{years, plural, one {year} other {years}}', { count, years: value });
}

/** A number of the server's with the unit that it names itself, as metrics have: converted to what is read at a table. */
export function formatMeasure(value: number | null, unit: string): string {
  if (value === null || !Number.isFinite(value)) return kNone;
  const known = kMeasures[unit];
  if (known) return withUnit(value, known);
  const text = plain(value);
  return unit === '1' || unit === '' ? text : `${text}${kNarrowSpace}${unit}`;
}

/** Digits of a measure without its unit, for a column whose head names the unit. */
export function measureDigits(value: number | null, unit: string): string {
  if (value === null || !Number.isFinite(value)) return kNone;
  const known = kMeasures[unit];
  return known ? digits(value, known) : plain(value);
}

/** A measure as a number in the unit that `formatMeasure` shows, for a place on an axis. */
export const shownValue = (value: number, unit: string): number => value * (kMeasures[unit]?.perSi ?? 1);

/** Writes shares as percentages, a judged answer as a word, other values with their unit. */
export function formatScore({
  value,
  unit,
  shown_as,
}: {
  readonly value: number | null;
  readonly unit: string;
  readonly shown_as: 'number' | 'share' | 'correct_or_incorrect';
}): string {
  if (value === null) return kNone;
  if (shown_as === 'correct_or_incorrect') return value === 1 ? say('correct') : say('incorrect');
  if (shown_as === 'share') return formatShare(share(value), value > 0 && value < 0.01 ? 3 : 0);
  return formatMeasure(value, unit);
}

/** The unit that `formatMeasure` shows for a unit of the server's. */
export const shownUnit = (unit: string) => kMeasures[unit]?.unit ?? (unit === '1' ? '' : unit);

const kMeasures: Record<string, Quantity | undefined> = {
  N: kForce,
  'N·m': kTorque,
  Nm: kTorque,
  m: kLength,
  s: kTime,
  rad: kAngle,
  '%': { name: 'Share', unit: '%', perSi: 1, decimals: 0 },
  'm/s': kSpeed,
  'N^2': { name: 'Variance of force', unit: 'N²', perSi: 1, decimals: 1 },
  'm^3': { name: 'Volume', unit: 'mm³', perSi: 1e9, decimals: 1 },
  'm^2/s^2': { name: 'Variance of speed', unit: 'mm²/s²', perSi: 1e6, decimals: 1 },
};

function plain(value: number): string {
  if (Number.isInteger(value)) return formatCount(value);
  const magnitude = Math.abs(value);
  const decimals = magnitude >= 100 ? 0 : magnitude >= 10 ? 1 : magnitude >= 1 ? 2 : 3;
  return digits(value, { name: '', unit: '', perSi: 1, decimals });
}
