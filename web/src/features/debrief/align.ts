/** Two trials on one case beside each other: which moment of the other goes with a moment of this one. */

/** The tip's way of a trial against its time. */
export interface Way {
  readonly t_s: readonly number[];
  readonly depth_m: readonly number[];
  readonly force_N: readonly number[];
}

export type Moments = (t_s: number) => number;

const kKnots = 24;

/** When each depth was first reached, for depths that rise; a trial that never got there is left out by the caller. */
function firstTimes(way: Way, depths: readonly number[]): number[] {
  const out: number[] = [];
  let i = 0;
  for (const depth of depths) {
    while (i < way.depth_m.length - 1 && (way.depth_m[i] ?? 0) < depth) ++i;
    out.push(way.t_s[i] ?? 0);
  }
  return out;
}

const last = (values: readonly number[]) => values.at(-1) ?? 0;
const deepest = (way: Way) => way.depth_m.reduce((most, depth) => Math.max(most, depth), 0);

/**
 * By progress along the tract: the moments when both first reached a depth go together, and so do their beginnings and ends; between them
 * time runs evenly. How deep both got counts; what only one of them reached is part of the last stretch.
 */
export function byProgress(mine: Way, theirs: Way): Moments {
  const common = Math.min(deepest(mine), deepest(theirs));
  const depths = Array.from({ length: kKnots }, (_, k) => (common * (k + 1)) / kKnots).filter((depth) => depth > 0);
  const from = [0, ...firstTimes(mine, depths), last(mine.t_s)],
    to = [0, ...firstTimes(theirs, depths), last(theirs.t_s)];
  return (t_s) => {
    let k = 0;
    while (k < from.length - 2 && (from[k + 1] ?? 0) <= t_s) ++k;
    const a = from[k] ?? 0,
      b = from[k + 1] ?? a;
    const share = b > a ? Math.min(Math.max((t_s - a) / (b - a), 0), 1) : 1;
    const start = to[k] ?? 0;
    return start + share * ((to[k + 1] ?? start) - start);
  };
}

/** By the clock, from both beginnings; the other waits at its end. */
export const byTime =
  (theirs: Way): Moments =>
  (t_s) =>
    Math.min(t_s, last(theirs.t_s));

/** The row of the last sample that is not after a moment. */
export function rowAt(t_s: readonly number[], at: number): number {
  let low = 0,
    high = t_s.length - 1;
  while (low < high) {
    const middle = (low + high + 1) >> 1;
    if ((t_s[middle] ?? 0) <= at) low = middle;
    else high = middle - 1;
  }
  return low;
}
