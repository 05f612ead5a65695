/** Topics with clocks of their own as one table: on the stamps of one of them, others interpolated, nothing invented. */
import { say } from '@/language';
import { formatTime, second } from '@/units';

/** A column of the table, as it is recorded. */
export interface Series {
  /** For messages: the topic. */
  readonly topic: string;
  readonly t_s: Float64Array;
  readonly values: readonly Float64Array[];
}

export interface Table {
  readonly t_s: Float64Array;
  /** Of each series, in order. */
  readonly values: readonly (readonly Float64Array[])[];
}

/** Neighbours further apart than so many of a topic's usual periods are a gap: no value is taken between them. */
export const kMostPeriods = 5;

/** Milliseconds matter here. */
const seconds = (value: number) => formatTime(second(value), 3);

/** Errors: stamps that do not rise, by topic and message. */
export function checkStamps({ topic, t_s }: Series) {
  for (let i = 1; i < t_s.length; ++i)
    if (!((t_s[i] ?? NaN) > (t_s[i - 1] ?? NaN)))
      throw new Error(
        say('{topic}: the time of message {n} is not later than that of the message before', { topic, n: i + 1 }),
      );
}

/** The median distance of neighbours. */
export function period_s(t_s: Float64Array): number {
  const gaps = t_s.slice(1).map((t, i) => t - (t_s[i] ?? t));
  gaps.sort();
  return gaps[gaps.length >> 1] ?? NaN;
}

/** Values of `series` at the stamps `at_s`, which lie within its own: on a line between its two neighbours. */
function interpolated(series: Series, at_s: Float64Array): Float64Array[] {
  const { t_s, values, topic } = series;
  const most_s = kMostPeriods * period_s(t_s);
  const out = values.map(() => new Float64Array(at_s.length));
  let after = 1;
  for (const [row, t] of at_s.entries()) {
    while (after < t_s.length - 1 && (t_s[after] ?? Infinity) < t) ++after;
    const from = t_s[after - 1] ?? NaN,
      to = t_s[after] ?? NaN;
    if (t !== from && t !== to && to - from > most_s)
      throw new Error(
        say('{topic} has a gap of {gap} at {time}. Keep a part of the recording without it.', {
          topic,
          gap: seconds(to - from),
          time: seconds(from),
        }),
      );
    const share = (t - from) / (to - from);
    for (const [i, column] of values.entries()) {
      const a = column[after - 1] ?? NaN,
        b = column[after] ?? NaN;
      const into = out[i];
      if (into) into[row] = share === 0 ? a : share === 1 ? b : a + share * (b - a);
    }
  }
  return out;
}

/** From `from_s` to `to_s` on the stamps of `base`, as far as every series reaches. */
export function joined(base: Series, others: readonly Series[], from_s = -Infinity, to_s = Infinity): Table {
  const all = [base, ...others];
  for (const series of all) {
    if (series.t_s.length < 2) throw new Error(say('{topic} has fewer than two messages', { topic: series.topic }));
    checkStamps(series);
  }
  const low = Math.max(from_s, ...all.map(({ t_s }) => t_s[0] ?? NaN)),
    high = Math.min(to_s, ...all.map(({ t_s }) => t_s[t_s.length - 1] ?? NaN));
  const isWithin = (t: number) => t >= low && t <= high;
  const t_s = base.t_s.filter(isWithin);
  if (t_s.length < 2) throw new Error(say('The topics have no common time: fewer than two stamps lie in all of them.'));
  const first = base.t_s.indexOf(t_s[0] ?? NaN);
  const own = base.values.map((column) => column.slice(first, first + t_s.length));
  return { t_s, values: [own, ...others.map((series) => interpolated(series, t_s))] };
}
