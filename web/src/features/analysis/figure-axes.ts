/** Axes of a figure: their ranges and ticks. Pure. */
import { formatCount } from '@/units';

export type Points = readonly (number | null)[];
export interface Span {
  readonly from: number;
  readonly to: number;
}

const kMostNameCharacters = 48;

/** Least and most of the numbers, with a margin on both sides. */
export function spanOf(values: readonly Points[], margin: number): Span {
  let from = Infinity,
    to = -Infinity;
  for (const list of values)
    for (const value of list)
      if (value !== null) {
        from = Math.min(from, value);
        to = Math.max(to, value);
      }
  if (from > to) return { from: 0, to: 1 };
  const room = (to - from || Math.abs(to) || 1) * margin;
  return { from: from - room, to: to + room };
}

/** The names of groups stand on the axis where they have room; the numbers always do. */
export function groupTicks(names: readonly string[]) {
  const roomy = names.join('').length <= kMostNameCharacters && names.length <= 6;
  return names.map((name, i) => ({ at: i + 1, text: roomy ? name : formatCount(i + 1) }));
}
