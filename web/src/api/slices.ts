/** A plane of a volume as grey pixels, described by headers. */
import { ApiError } from './client';

export type Vec3 = readonly [number, number, number];
export type SlicePlane = 'axial' | 'coronal' | 'sagittal';

export interface Slice {
  readonly width: number;
  readonly height: number;
  /** m of a pixel, along rows and along columns */
  readonly spacing_m: readonly [number, number];
  /** LPS, centre of the first pixel */
  readonly origin_m: Vec3;
  /** Unit vectors, LPS: towards growing columns, towards growing rows. */
  readonly alongRow: Vec3;
  readonly alongColumn: Vec3;
  /** [row][column], 0…255 */
  readonly pixels: Uint8Array<ArrayBuffer>;
}

function numbers(headers: Headers, name: string, lengths: readonly number[]): number[] {
  const values = (headers.get(name) ?? '')
    .split(/[\s,]+/)
    .filter(Boolean)
    .map(Number);
  if (!lengths.includes(values.length) || !values.every(Number.isFinite)) {
    throw new ApiError(
      'unreadable',
      `The server's answer cannot be read: header ${name} needs ${lengths.join(' or ')} numbers.`,
    );
  }
  return values;
}

const triple = (values: readonly number[], from = 0): Vec3 => [
  values[from] ?? 0,
  values[from + 1] ?? 0,
  values[from + 2] ?? 0,
];

export function parseSlice(headers: Headers, pixels: Uint8Array<ArrayBuffer>): Slice {
  const [width = 0, height = 0] = numbers(headers, 'X-Dims', [2]);
  if (width * height !== pixels.length || width < 1)
    throw new ApiError(
      'unreadable',
      `The server's answer cannot be read: ${pixels.length} pixels for ${width} × ${height}.`,
    );
  const [across = 0, down = across] = numbers(headers, 'X-Spacing-m', [1, 2]);
  const along = numbers(headers, 'X-Directions', [6]);
  return {
    width,
    height,
    pixels,
    spacing_m: [across, down],
    origin_m: triple(numbers(headers, 'X-Origin-m', [3])),
    alongRow: triple(along),
    alongColumn: triple(along, 3),
  };
}
