/** Round ticks of a scale, and curves between two scales. Pure. */
import type { ScaleLinear } from 'd3-scale';
import { tickLabels } from '@/units';

export type Scale = ScaleLinear<number, number>;

export interface Tick {
  readonly at: number;
  readonly text: string;
}

/** Ticks with their labels, at most `most` steps apart from end to end. */
export function ticksOf(scale: Scale, most: number): Tick[] {
  let count = Math.floor(most);
  while (count > 1 && scale.ticks(count).length > most + 1) --count;
  const at = scale.ticks(count);
  const texts = tickLabels(at, Math.abs((at[1] ?? 0) - (at[0] ?? 0)));
  return at.map((value, i) => ({ at: value, text: texts[i] ?? '' }));
}

/** Where a scale begins and ends on the picture. */
export function ends(scale: Scale): readonly [number, number] {
  const [start_px = 0, end_px = 0] = scale.range();
  return [start_px, end_px];
}

/** "M x y L x y …" of a curve; points that are not numbers are left out. */
export function linePath(x: readonly number[], y: readonly number[], across: Scale, up: Scale): string {
  let path = '';
  x.forEach((value, i) => {
    const px = across(value),
      py = up(y[i] ?? Number.NaN);
    if (!Number.isFinite(px) || !Number.isFinite(py)) return;
    path += `${path === '' ? 'M' : 'L'}${Math.round(px * 10) / 10} ${Math.round(py * 10) / 10}`;
  });
  return path;
}

/** The index whose place on the picture is nearest. */
export function nearestPoint(
  x: readonly number[],
  y: readonly number[],
  across: Scale,
  up: Scale,
  px: number,
  py: number,
): number {
  let best = -1,
    least = Infinity;
  x.forEach((value, i) => {
    const distance = (across(value) - px) ** 2 + (up(y[i] ?? Number.NaN) - py) ** 2;
    if (distance < least) {
      least = distance;
      best = i;
    }
  });
  return best;
}
