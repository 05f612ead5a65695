/**
 * Level of detail: a trial is cut into 2^level equal tiles, each fetched with the same number of points.
 *
 *     level 0   |-------------------------------|
 *     level 1   |---------------|---------------|
 *     level 2   |-------|-------|-------|-------|      shown: the level whose points are about as dense as the pixels
 *
 * So what is fetched depends on the place in the trial and not on the exact view: tiles are shared between views, and
 * panning needs only the neighbours.
 */
import type { Range } from './range';

export const kTilePoints = 1024;
/** Least and greatest are drawn for every point, so fewer points than pixels still show every peak. */
const kPointsPerPixel = 0.75;

export interface Tile {
  readonly level: number;
  readonly index: number;
}

export function tileRange({ level, index }: Tile, duration: number): Range {
  const length = duration / 2 ** level;
  return { from: index * length, to: (index + 1) * length };
}

/** The finest level that still has samples to tell apart. */
export function finestLevel(samples: number): number {
  return Math.max(0, Math.ceil(Math.log2(samples / kTilePoints)));
}

export function levelFor(range: Range, width_px: number, duration: number, samples: number): number {
  const span = range.to - range.from;
  if (!(span > 0) || !(width_px > 0)) return 0;
  const wanted = Math.ceil(Math.log2((duration * width_px * kPointsPerPixel) / (kTilePoints * span)));
  return Math.min(Math.max(wanted, 0), finestLevel(samples));
}

/** Tiles that the view touches, and one neighbour on either side, so that panning finds them there. */
export function tilesFor(range: Range, width_px: number, duration: number, samples: number): Tile[] {
  const level = levelFor(range, width_px, duration, samples);
  const count = 2 ** level;
  const length = duration / count;
  const first = Math.max(0, Math.floor(range.from / length) - 1);
  const last = Math.min(count - 1, Math.ceil(range.to / length));
  return Array.from({ length: last - first + 1 }, (_, i) => ({ level, index: first + i }));
}

/** Least and greatest of a channel at each point of `t`. */
export interface Envelope {
  readonly min: readonly (number | null)[];
  readonly max: readonly (number | null)[];
}

export interface Detail {
  readonly t: readonly number[];
  readonly channels: Readonly<Record<string, Envelope>>;
  /** Recorded samples that one drawn point stands for; 1 is the recording itself. */
  readonly samplesPerPoint: number;
}

export const kNoDetail: Detail = { t: [], channels: {}, samplesPerPoint: 0 };

/** The tile itself, or the nearest coarser one that holds it. */
export function coarser({ level, index }: Tile): Tile | null {
  return level === 0 ? null : { level: level - 1, index: Math.floor(index / 2) };
}

/** For each tile the best detail at hand, cut to the tile's time and put end to end. */
export function assemble(tiles: readonly Tile[], held: (tile: Tile) => Detail | undefined, duration: number): Detail {
  const t: number[] = [];
  const channels: Record<string, { min: (number | null)[]; max: (number | null)[] }> = {};
  let samplesPerPoint = 0;
  for (const tile of tiles) {
    let source: Tile | null = tile;
    let detail = held(tile);
    while (!detail && (source = coarser(source))) detail = held(source);
    if (!detail) continue;
    samplesPerPoint = Math.max(samplesPerPoint, detail.samplesPerPoint);
    const { from, to } = tileRange(tile, duration);
    const last = tile.index === 2 ** tile.level - 1;
    const first = Math.max(lowerBound(detail.t, from), t.length > 0 ? upperBound(detail.t, t.at(-1) ?? from) : 0);
    const end = last ? detail.t.length : lowerBound(detail.t, to);
    for (let i = first; i < end; ++i) t.push(detail.t[i] ?? 0);
    for (const [name, envelope] of Object.entries(detail.channels)) {
      const into = (channels[name] ??= { min: [], max: [] });
      for (let i = first; i < end; ++i) {
        into.min.push(envelope.min[i] ?? null);
        into.max.push(envelope.max[i] ?? null);
      }
    }
  }
  return { t, channels, samplesPerPoint };
}

/** First index whose value is ≥ x. */
export function lowerBound(sorted: readonly number[], x: number): number {
  let low = 0,
    high = sorted.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if ((sorted[middle] ?? 0) < x) low = middle + 1;
    else high = middle;
  }
  return low;
}

/** First index whose value is > x. */
export function upperBound(sorted: readonly number[], x: number): number {
  let low = lowerBound(sorted, x);
  while (low < sorted.length && sorted[low] === x) low += 1;
  return low;
}
