/** The stretch of time that a chart shows. Pure: a range in, a range out, never outside the trial. */
export interface Range {
  readonly from: number;
  readonly to: number;
}

/** Below this nothing more can be seen at any sampling rate of ours. */
const kLeast_s = 0.002;

/** Moves and shrinks a range so that it lies in 0…duration. */
export function clamp(range: Range, duration: number): Range {
  const least = Math.min(kLeast_s, duration);
  const span = Math.min(Math.max(range.to - range.from, least), duration);
  const middle = (range.from + range.to) / 2;
  const from = Math.min(Math.max(middle - span / 2, 0), duration - span);
  return { from, to: from + span };
}

/** `factor` < 1 zooms in; the moment `about` stays where it is on the screen. */
export function zoomed(range: Range, factor: number, about: number, duration: number): Range {
  const span = range.to - range.from;
  const next = Math.min(Math.max(span * factor, Math.min(kLeast_s, duration)), duration);
  const place = span > 0 ? (about - range.from) / span : 0.5;
  const from = about - place * next;
  return clamp({ from, to: from + next }, duration);
}

/** `by` in shares of what is shown: 0.1 moves a tenth later. */
export function panned(range: Range, by: number, duration: number): Range {
  const step = (range.to - range.from) * by;
  return clamp({ from: range.from + step, to: range.to + step }, duration);
}

export const whole = (duration: number): Range => ({ from: 0, to: duration });

export function isWhole(range: Range, duration: number): boolean {
  return range.from <= 0 && range.to >= duration;
}
