/** The bone round the tract as a small block of opacities, described by headers. */
import { ApiError } from './client';
import type { Vec3 } from './slices';

export interface Preview {
  readonly dims: readonly [number, number, number];
  readonly spacing_m: readonly [number, number, number];
  readonly origin_m: readonly [number, number, number];
  /** Row-major 3 × 3; its columns are the directions of i, j, k in the patient's frame. */
  readonly directions: readonly number[];
  /** [k][j][i], 0 clear to 255 opaque */
  readonly opacity: Uint8Array<ArrayBuffer>;
}

function numbers(headers: Headers, name: string, length: number): number[] {
  const values = (headers.get(name) ?? '')
    .split(/[\s,]+/)
    .filter(Boolean)
    .map(Number);
  if (values.length !== length || !values.every(Number.isFinite)) {
    throw new ApiError('unreadable', `The server's answer cannot be read: header ${name} needs ${length} numbers.`);
  }
  return values;
}

const triple = (values: number[]) => [values[0] ?? 0, values[1] ?? 0, values[2] ?? 0] as const;

export function parsePreview(headers: Headers, opacity: Uint8Array<ArrayBuffer>): Preview {
  const dims = numbers(headers, 'X-Dims', 3);
  const voxels = dims.reduce((product, n) => product * n, 1);
  if (!dims.every((n) => Number.isInteger(n) && n > 0 && n <= 512) || voxels !== opacity.length) {
    throw new ApiError(
      'unreadable',
      `The server's answer cannot be read: ${opacity.length} voxels for ${dims.join(' × ')}.`,
    );
  }
  return {
    dims: triple(dims),
    spacing_m: triple(numbers(headers, 'X-Spacing-m', 3)),
    origin_m: triple(numbers(headers, 'X-Origin-m', 3)),
    directions: numbers(headers, 'X-Directions', 9),
    opacity,
  };
}

/** Corners of the box of the voxel centres along the patient's axes. */
export function boundsOf({
  dims,
  spacing_m,
  origin_m,
  directions: d,
}: Pick<Preview, 'dims' | 'spacing_m' | 'origin_m' | 'directions'>): { low: Vec3; high: Vec3 } {
  const low = [Infinity, Infinity, Infinity],
    high = [-Infinity, -Infinity, -Infinity];
  for (let corner = 0; corner < 8; ++corner) {
    for (const row of [0, 1, 2] as const) {
      let at = origin_m[row];
      for (const i of [0, 1, 2] as const)
        at += (corner >> i) & 1 ? (d[3 * row + i] ?? 0) * (dims[i] - 1) * spacing_m[i] : 0;
      low[row] = Math.min(low[row] ?? 0, at);
      high[row] = Math.max(high[row] ?? 0, at);
    }
  }
  return { low: [low[0] ?? 0, low[1] ?? 0, low[2] ?? 0], high: [high[0] ?? 0, high[1] ?? 0, high[2] ?? 0] };
}
