/** Which measures stand in the published table, and how the others read. */
import type { Metric } from '@/api';
import { formatMeasure, formatShare, kNone, share } from '@/units';

export const kStatistics = [
  { id: 'mean', label: 'Mean' },
  { id: 'sd', label: 'SD' },
  { id: 'max', label: 'Max' },
] as const;

export const kKinds = [
  { id: 'force_xy', symbol: 'F', index: 'xy', label: 'Transverse force' },
  { id: 'force_z', symbol: 'F', index: 'z', label: 'Axial force' },
  { id: 'torque_xy', symbol: 'T', index: 'xy', label: 'Bending torque' },
  { id: 'torque_z', symbol: 'T', index: 'z', label: 'Twisting torque' },
] as const;

export interface TableRow {
  readonly kind: (typeof kKinds)[number];
  readonly cells: readonly (Metric | undefined)[];
}

/** Rows of the published layout, and all measures that are not in it, in the server's order. */
export function arranged(metrics: readonly Metric[]): { table: TableRow[]; others: Metric[] } {
  const byId = new Map(metrics.map((metric) => [metric.id, metric]));
  const table = kKinds.map((kind) => ({ kind, cells: kStatistics.map(({ id }) => byId.get(`${kind.id}_${id}`)) }));
  const placed = new Set(table.flatMap((row) => row.cells.map((cell) => cell?.id)));
  return { table, others: metrics.filter((metric) => !placed.has(metric.id)) };
}

/** Shares read in per cent, a judgement as a word, all else with its unit. */
export function shown(metric: Metric): string {
  const { id, value, unit } = metric;
  if (value === null) return kNone;
  if (id === 'answer_right') return value === 1 ? 'correct' : 'incorrect';
  if (unit === '1' && (id.endsWith('_share') || id.startsWith('wall_coverage')))
    return formatShare(share(value), value > 0 && value < 0.01 ? 3 : 0);
  return formatMeasure(value, unit);
}
