/** From depth and force to the place on the picture, and round ticks between. Pure. */
export interface Scale {
  readonly from: number;
  readonly to: number;
  readonly start_px: number;
  readonly end_px: number;
}

export const placeOf = (scale: Scale, value: number): number =>
  scale.start_px + ((value - scale.from) / (scale.to - scale.from)) * (scale.end_px - scale.start_px);

/** A step of 1, 2 or 5 times a power of ten, so that at most `most` steps fit `span`. */
export function roundStep(span: number, most: number): number {
  if (!(span > 0) || most < 1) return 1;
  const power = 10 ** Math.floor(Math.log10(span / most));
  const fitting = [1, 2, 5, 10].find((factor) => span / (factor * power) <= most);
  return (fitting ?? 10) * power;
}

export function ticksOf(from: number, to: number, step: number): number[] {
  const ticks: number[] = [];
  for (let n = Math.ceil(from / step - 1e-9); n * step <= to + 1e-9 * step; ++n) ticks.push(n * step + 0);
  return ticks;
}

/** "M x y L x y …" of a curve; points that are not numbers are left out. */
export function linePath(x: readonly number[], y: readonly number[], across: Scale, up: Scale): string {
  let path = '';
  x.forEach((value, i) => {
    const px = placeOf(across, value),
      py = placeOf(up, y[i] ?? Number.NaN);
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
    const distance = (placeOf(across, value) - px) ** 2 + (placeOf(up, y[i] ?? Number.NaN) - py) ** 2;
    if (distance < least) {
      least = distance;
      best = i;
    }
  });
  return best;
}
