/** Numbers of any size: as many digits as mean something, and no more. SI in; millimetres, milliseconds and degrees out. */
import { digits, formatBytes, kNone, united } from './format';
import type { Quantity } from './quantity';

/** Units in which a fitted number is read at a table; all others stay SI. */
const kShown: Record<string, { unit: string; perSi: number } | undefined> = {
  m: { unit: 'mm', perSi: 1000 },
  rad: { unit: '°', perSi: 180 / Math.PI },
  'm/s': { unit: 'mm/s', perSi: 1000 },
  kg: { unit: 'g', perSi: 1000 },
  Nm: { unit: 'N·m', perSi: 1 },
  '1': { unit: '', perSi: 1 },
};

const shownAs = (unit: string) => kShown[unit] ?? { unit, perSi: 1 };

/** Decimals that leave `figures` significant digits of a magnitude; none are kept before the point's sake alone. */
function decimalsOf(magnitude: number, figures: number): number {
  if (!(magnitude > 0)) return 0;
  return Math.min(Math.max(figures - 1 - Math.floor(Math.log10(magnitude) + 1e-12), 0), 9);
}

/** The unit in which such a figure is typed and read, and how many of it make one SI unit. */
export const typedIn = (unit: string): { readonly unit: string; readonly perSi: number } => shownAs(unit);

const spelled = (value: number, unit: string, decimals: number) => {
  const as: Quantity = { name: '', decimals, ...shownAs(unit) };
  const text = digits(value, as, decimals);
  return as.unit === '' ? text : united(text, as);
};

/** "2.31 N", "0.0123", "1 230 N/m": three significant digits. */
export function formatFigure(value: number | null | undefined, unit = '', figures = 3): string {
  if (value === null || value === undefined || !Number.isFinite(value)) return kNone;
  return spelled(value, unit, decimalsOf(Math.abs(value) * shownAs(unit).perSi, figures));
}

/** A figure of a station's self-test: short times in ms and µs, room on a disk in GB, a share (it has no unit) in percent. */
export function formatFound(value: number | null, unit: string): string {
  if (value === null) return kNone;
  if (unit === 'B') return formatBytes(value);
  if (unit === '') return formatFigure(value * 100, '%');
  if (unit !== 's' || Math.abs(value) >= 1) return formatFigure(value, unit);
  return Math.abs(value) < 1e-3 ? formatFigure(value * 1e6, 'µs') : formatFigure(value * 1e3, 'ms');
}

/** "2.3813 ± 0.0011 N": two digits of the uncertainty, and the value to match. */
export function formatWithin(value: number | null, sd: number | null, unit = ''): string {
  if (value === null || !Number.isFinite(value)) return kNone;
  if (sd === null || !Number.isFinite(sd) || sd <= 0) return formatFigure(value, unit);
  const decimals = decimalsOf(sd * shownAs(unit).perSi, 2);
  const as: Quantity = { name: '', decimals, ...shownAs(unit) };
  return `${digits(value, as, decimals)} ± ${spelled(sd, unit, decimals)}`;
}

const kEndings = [
  'N_per_m',
  'Ns_per_m',
  'Ns2_per_m2',
  'Nms_per_rad',
  's_per_rad',
  'rad_s',
  'm_s',
  'per_m',
  'rad',
  'Nm',
  'kg',
  'Pa',
  'mm',
  'N',
  'm',
  's',
  'Hz',
] as const;
const kSpelled: Record<(typeof kEndings)[number], string> = {
  N_per_m: 'N/m',
  Ns_per_m: 'N·s/m',
  Ns2_per_m2: 'N·s²/m²',
  Nms_per_rad: 'N·m·s/rad',
  s_per_rad: 's/rad',
  rad_s: 'rad/s',
  m_s: 'm/s',
  per_m: '1/m',
  rad: 'rad',
  Nm: 'N·m',
  kg: 'kg',
  Pa: 'Pa',
  mm: 'mm',
  N: 'N',
  m: 'm',
  s: 's',
  Hz: 'Hz',
};

/** A name that ends in its unit, taken apart: "friction_N" → friction, N. */
export function nameAndUnit(name: string): { name: string; unit: string } {
  const ending = kEndings.find((one) => name.endsWith(`_${one}`));
  if (!ending) return { name: name.replaceAll('_', ' '), unit: '' };
  return { name: name.slice(0, -(ending.length + 1)).replaceAll('_', ' '), unit: kSpelled[ending] };
}

/** A number for a field to be typed over: what twelve digits leave of it, without the dust of a factor. */
export const plainNumber = (value: number): string => String(Number.parseFloat(value.toPrecision(12)));
