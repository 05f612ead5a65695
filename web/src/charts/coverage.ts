/** The wall of the tract unrolled: which parts were touched, and how much of each side. */
export interface WallBins {
  readonly depthBins: number;
  readonly angleBins: number;
  /** [depth][angle], samples in contact. Bins are centred on their angle: 0 medial, a quarter turn superior, half lateral. */
  readonly samples: readonly number[];
}

export const kSides = ['medial', 'superior', 'lateral', 'inferior'] as const;
export type Side = (typeof kSides)[number];

/** The side that an angle bin faces: each side is the quarter turn centred on its direction. */
export function sideOf(angleBin: number, angleBins: number): Side {
  return kSides[Math.floor((angleBin / angleBins) * 4 + 0.5) % 4] ?? 'medial';
}

/** Bins touched, of all, per side. */
export function coveredBySide({
  depthBins,
  angleBins,
  samples,
}: WallBins): Record<Side, { touched: number; bins: number }> {
  const found = {
    medial: { touched: 0, bins: 0 },
    superior: { touched: 0, bins: 0 },
    lateral: { touched: 0, bins: 0 },
    inferior: { touched: 0, bins: 0 },
  };
  for (let d = 0; d < depthBins; ++d) {
    for (let a = 0; a < angleBins; ++a) {
      const side = found[sideOf(a, angleBins)];
      side.bins += 1;
      if ((samples[d * angleBins + a] ?? 0) > 0) side.touched += 1;
    }
  }
  return found;
}

/** Column of the map for an angle bin: the map starts where the medial side does, so that no side is cut in two. */
export function columnOf(angleBin: number, angleBins: number): number {
  return (angleBin + Math.floor(angleBins / 8)) % angleBins;
}

export const kHeatLevels = 5;

/** The angle bin that a column of the map shows. */
export const binOf = (column: number, angleBins: number) =>
  (column - Math.floor(angleBins / 8) + angleBins) % angleBins;

/** 0 untouched, then 1…5 up to the most touched bin, by the root, so that a short contact still shows. */
export function heatOf(samples: number, most: number): number {
  if (samples <= 0) return 0;
  return Math.min(kHeatLevels, 1 + Math.floor(Math.sqrt(samples / most) * kHeatLevels));
}

/** One SVG path per heat level, of unit squares: column × row. */
export function heatPaths({ depthBins, angleBins, samples }: WallBins): string[] {
  const most = samples.reduce((greatest, n) => Math.max(greatest, n), 0);
  const paths = Array.from({ length: kHeatLevels + 1 }, () => '');
  for (let d = 0; d < depthBins; ++d) {
    for (let a = 0; a < angleBins; ++a) {
      const level = heatOf(samples[d * angleBins + a] ?? 0, most);
      paths[level] = `${paths[level] ?? ''}M${columnOf(a, angleBins)} ${d}h1v1h-1z`;
    }
  }
  return paths;
}
