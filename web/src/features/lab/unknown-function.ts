/** The rows of a function that is a table: forces at the knots of one signal, or of two. */
import type { Diagnosis } from '@/api';

type Unknown = NonNullable<NonNullable<Diagnosis['discovery']>['unknown']>;

export interface TableRow {
  /** The first signal's knot. */
  readonly at: number | null;
  /** One force, or one for each knot of the second signal, which runs faster in the answer. */
  readonly force_N: readonly (number | null)[];
}

export function tableRows({ knots, force_N }: Pick<Unknown, 'knots' | 'force_N'>): TableRow[] {
  const across = knots[1]?.length ?? 1;
  return (knots[0] ?? []).map((at, row) => ({ at, force_N: force_N.slice(row * across, (row + 1) * across) }));
}
