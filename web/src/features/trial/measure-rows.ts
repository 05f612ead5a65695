/** Lays the metrics out as the server describes them: in the table of statistics, or one by one. */
import type { Metric } from '@/api';
import { formatScore } from '@/units';

export interface TableRow {
  readonly label: string;
  /** As F_xy: letter and index. */
  readonly symbol: string;
  readonly cells: readonly (Metric | undefined)[];
}

export interface Arranged {
  /** Headings of the table's columns. */
  readonly statistics: readonly string[];
  readonly rows: readonly TableRow[];
  /** Metrics without a place in the table. */
  readonly others: readonly Metric[];
}

const unique = (texts: readonly string[]) => [...new Set(texts)];

/** Rows stand in the order in which the metrics first name them; columns in the order mean, SD, maximum. */
export function arranged(metrics: readonly Metric[]): Arranged {
  const placed = metrics.flatMap((metric) => (metric.cell ? [{ metric, cell: metric.cell }] : []));
  const order = ['Mean', 'SD', 'Max'];
  const statistics = unique(placed.map(({ cell }) => cell.column)).sort((a, b) => order.indexOf(a) - order.indexOf(b));
  const rows = unique(placed.map(({ cell }) => cell.row)).map((label) => {
    const inRow = placed.filter(({ cell }) => cell.row === label);
    return {
      label,
      symbol: inRow[0]?.cell.symbol ?? '',
      cells: statistics.map((column) => inRow.find(({ cell }) => cell.column === column)?.metric),
    };
  });
  return { statistics, rows, others: metrics.filter((metric) => !metric.cell) };
}

export const shown = (metric: Metric): string => formatScore(metric);
