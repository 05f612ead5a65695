/** The bone round the tract as a small block of opacities, described by headers. */
import { ApiError } from './client';

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
