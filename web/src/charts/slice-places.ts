/** Where a point of the patient lies on a slice, and a point of the slice in the patient. */
import { dot, sum, scaled, type Vec3 } from './scene/types';

/** Grey pixels of a plane and where they lie; LPS, SI. */
export interface SlicePicture {
  readonly width: number;
  readonly height: number;
  readonly spacing_m: readonly [number, number];
  readonly origin_m: Vec3;
  readonly alongRow: Vec3;
  readonly alongColumn: Vec3;
  readonly pixels: Uint8Array;
}

/** Something that is drawn over a slice: a point, or a line where it has a second end. */
export interface SliceMark {
  readonly id: string;
  readonly at: Vec3;
  readonly to?: Vec3;
  readonly text?: string;
  readonly look: 'entry' | 'target' | 'tract' | 'wall' | 'breach' | 'thin';
  /** Width of a line, in hundredths of the picture. */
  readonly wide?: number;
  /** It cannot be dragged. */
  readonly fixed?: boolean;
}

/** A ball that is drawn where the slice cuts it. */
export interface SliceBall {
  readonly at: Vec3;
  readonly radius_m: number;
  readonly sign: '+' | '−';
}

/** A brush that paints balls instead of placing a mark. */
export interface SliceBrush {
  readonly radius_m: number;
  readonly sign: '+' | '−' | '×';
  /** Where the arrow keys have it. */
  readonly cursor: Vec3;
  readonly onCursor: (at: Vec3) => void;
  /** `first`: a stroke begins; the others of it follow. */
  readonly onPaint: (at: Vec3, first: boolean) => void;
}

/** Unit vector across the slice. */
export function normalOf({ alongRow: u, alongColumn: w }: Pick<SlicePicture, 'alongRow' | 'alongColumn'>): Vec3 {
  return [u[1] * w[2] - u[2] * w[1], u[2] * w[0] - u[0] * w[2], u[0] * w[1] - u[1] * w[0]];
}

/** Radius of the disc in which a plane cuts a ball; 0 where it passes the ball by. */
export const discRadius_m = (radius_m: number, off_m: number) =>
  Math.abs(off_m) < radius_m ? Math.sqrt(radius_m ** 2 - off_m ** 2) : 0;

/** The places of a brush on its way from the last place that it painted, one for each `step_m`. */
export function stroke(from: Vec3, to: Vec3, step_m: number): Vec3[] {
  const way = sum(to, scaled(from, -1));
  const steps = Math.floor(Math.sqrt(dot(way, way)) / step_m + 1e-9);
  const share = step_m / Math.sqrt(dot(way, way));
  return Array.from({ length: steps }, (_, i) => sum(from, scaled(way, (i + 1) * share)));
}

/** In pixels from the corner of the first one; how far off the plane. */
export function onSlice(picture: SlicePicture, p: Vec3): { x: number; y: number; off_m: number } {
  const from = sum(p, scaled(picture.origin_m, -1));
  return {
    x: dot(from, picture.alongRow) / picture.spacing_m[0] + 0.5,
    y: dot(from, picture.alongColumn) / picture.spacing_m[1] + 0.5,
    off_m: dot(from, normalOf(picture)),
  };
}

/** The point of the plane itself. */
export function onPlane(picture: SlicePicture, x: number, y: number): Vec3 {
  return sum(
    picture.origin_m,
    scaled(picture.alongRow, (x - 0.5) * picture.spacing_m[0]),
    scaled(picture.alongColumn, (y - 0.5) * picture.spacing_m[1]),
  );
}

/** The point of the plane that is nearest to a point of the patient. */
export function inPlane(picture: SlicePicture, p: Vec3): Vec3 {
  const { x, y } = onSlice(picture, p);
  return onPlane(picture, x, y);
}

const kLetters = [
  ['R', 'L'],
  ['A', 'P'],
  ['I', 'S'],
] as const;

/** The side of the patient that lies at an edge of the picture: R, L, A, P, S or I, of LPS the nearest. */
export function letterAt(
  { alongRow, alongColumn }: Pick<SlicePicture, 'alongRow' | 'alongColumn'>,
  edge: 'left' | 'right' | 'top' | 'bottom',
): string {
  const along = edge === 'left' || edge === 'right' ? alongRow : alongColumn;
  const ahead = edge === 'right' || edge === 'bottom';
  const axis = ([0, 1, 2] as const).reduce<0 | 1 | 2>(
    (most, i) => (Math.abs(along[i]) > Math.abs(along[most]) ? i : most),
    0,
  );
  return kLetters[axis][along[axis] > 0 === ahead ? 1 : 0];
}
