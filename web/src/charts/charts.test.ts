import { scaleLinear } from 'd3-scale';
import { describe, expect, it } from 'vitest';
import { linePath, nearestPoint, ticksOf } from './depth-scale';
import { columnOf, coveredBySide, heatOf, heatPaths, sideOf } from './coverage';
import { clamp, panned, whole, zoomed } from './range';
import { opacityAt } from './scene/slice';
import {
  assemble,
  finestLevel,
  kTilePoints,
  levelFor,
  lowerBound,
  tileRange,
  tilesFor,
  upperBound,
  type Detail,
  type Tile,
} from './tiles';
import { mostTicks, ticks } from './plane';
import { keyed } from './use-navigation';

describe('the view', () => {
  it('keeps the moment under the pointer where it is while zooming', () => {
    const next = zoomed({ from: 10, to: 20 }, 0.5, 12, 100);
    // 12 s lay at a fifth of the view; of 5 s a fifth is 1 s: 11 … 16.
    expect(next.from).toBeCloseTo(11, 12);
    expect(next.to).toBeCloseTo(16, 12);
  });

  it('never leaves the trial', () => {
    expect(panned({ from: 95, to: 99 }, 1, 100)).toEqual({ from: 96, to: 100 });
    expect(panned({ from: 1, to: 5 }, -1, 100)).toEqual({ from: 0, to: 4 });
    expect(zoomed({ from: 20, to: 90 }, 10, 50, 100)).toEqual(whole(100));
    expect(clamp({ from: -5, to: 300 }, 100)).toEqual(whole(100));
  });

  it('does not shrink to nothing', () => {
    const next = zoomed({ from: 1, to: 1.004 }, 1e-9, 1.002, 100);
    expect(next.to - next.from).toBeCloseTo(0.002, 12);
  });

  it('is moved by keys, and only by keys of its own', () => {
    expect(keyed('ArrowRight', { from: 0, to: 10 }, 100)).toEqual({ from: 1, to: 11 });
    expect(keyed('End', { from: 0, to: 10 }, 100)).toEqual({ from: 90, to: 100 });
    expect(keyed('0', { from: 3, to: 10 }, 100)).toEqual(whole(100));
    expect(keyed('Tab', { from: 0, to: 10 }, 100)).toBeUndefined();
  });
});

describe('the level of detail', () => {
  const duration = 250,
    samples = 1_000_000; // 4 kHz

  it('is one tile for the whole trial', () => {
    expect(tilesFor(whole(duration), 1200, duration, samples)).toEqual([{ level: 0, index: 0 }]);
  });

  it('has at least three points for four pixels wherever the recording has them', () => {
    for (const span of [200, 80, 30, 7, 1, 0.3]) {
      const level = levelFor({ from: 10, to: 10 + span }, 1200, duration, samples);
      const pointsShown = (span / (duration / 2 ** level)) * kTilePoints;
      const recorded = span * 4000;
      expect(pointsShown).toBeGreaterThanOrEqual(Math.min(0.75 * 1200, recorded) - 1e-6);
      expect(pointsShown, 'and not eight times too many').toBeLessThan(8 * 1200);
    }
  });

  it('goes no finer than the samples', () => {
    // 10⁶ / 1024 = 976.6 tiles of single samples: 2¹⁰ is the first power of two that holds them.
    expect(finestLevel(samples)).toBe(10);
    expect(levelFor({ from: 0, to: 1e-6 }, 4000, duration, samples)).toBe(10);
    expect(finestLevel(500)).toBe(0);
  });

  it('fetches the neighbours too, but nothing outside the trial', () => {
    const tiles = tilesFor({ from: 0, to: 10 }, 1200, duration, samples);
    expect(tiles[0]?.index).toBe(0);
    const inside = tilesFor({ from: 120, to: 130 }, 1200, duration, samples);
    const first = inside[0],
      last = inside.at(-1);
    if (!first || !last) throw new Error('no tiles');
    expect(tileRange(first, duration).to).toBeLessThanOrEqual(120);
    expect(tileRange(last, duration).from).toBeGreaterThanOrEqual(130);
  });
});

describe('a detail put together', () => {
  /** Ten points per tile; the value tells the level it came from. */
  const made = ({ level, index }: Tile): Detail => {
    const { from, to } = tileRange({ level, index }, 8);
    const t = Array.from({ length: 10 }, (_, i) => from + ((i + 0.5) / 10) * (to - from));
    return {
      t,
      channels: { a: { min: t.map(() => level), max: t.map(() => level + 0.5) } },
      samplesPerPoint: 2 ** (3 - level),
    };
  };
  const tiles: Tile[] = [
    { level: 2, index: 1 },
    { level: 2, index: 2 },
  ];

  it('is the fine tiles end to end, in order of time', () => {
    const { t, channels, samplesPerPoint } = assemble(tiles, made, 8);
    expect(t).toHaveLength(20);
    expect([...t].sort((a, b) => a - b)).toEqual(t);
    expect(new Set(channels.a?.min)).toEqual(new Set([2]));
    expect(samplesPerPoint).toBe(2);
  });

  it('takes from the nearest coarser tile what has not come yet', () => {
    const held = (tile: Tile) => (tile.level === 0 || (tile.level === 2 && tile.index === 1) ? made(tile) : undefined);
    const { t, channels, samplesPerPoint } = assemble(tiles, held, 8);
    const coarse = t.filter((_, i) => channels.a?.min[i] === 0);
    // Tile 2 of level 2 is 4 … 6 s; the whole has points at 0.4, 1.2, … of which 4.4 and 5.2 lie in it (and 6.0 not).
    expect(coarse.map((x) => x.toFixed(1))).toEqual(['4.4', '5.2']);
    expect(samplesPerPoint, 'the coarsest that is shown').toBe(8);
  });

  it('is empty when nothing has come', () => {
    expect(assemble(tiles, () => undefined, 8).t).toEqual([]);
  });

  it('never repeats a moment that two tiles share', () => {
    const shared: Detail = { t: [2, 3, 4], channels: { a: { min: [1, 1, 1], max: [1, 1, 1] } }, samplesPerPoint: 1 };
    const next: Detail = { t: [4, 5], channels: { a: { min: [1, 1], max: [1, 1] } }, samplesPerPoint: 1 };
    const { t } = assemble(tiles, ({ index }) => (index === 1 ? shared : next), 8);
    expect(t).toEqual([2, 3, 4, 5]);
  });
});

describe('searching in time', () => {
  it('finds the first at or after, and the first after', () => {
    expect(lowerBound([1, 2, 2, 3], 2)).toBe(1);
    expect(upperBound([1, 2, 2, 3], 2)).toBe(3);
    expect(lowerBound([], 2)).toBe(0);
  });
});

describe('the wall unrolled', () => {
  it('gives each side the quarter turn centred on its direction', () => {
    // Twelve bins of 30°, centred: medial is −30°, 0° and 30°.
    const sides = Array.from({ length: 12 }, (_, bin) => sideOf(bin, 12));
    expect(sides).toEqual([
      'medial',
      'medial',
      'superior',
      'superior',
      'superior',
      'lateral',
      'lateral',
      'lateral',
      'inferior',
      'inferior',
      'inferior',
      'medial',
    ]);
  });

  it('shows each side in one piece', () => {
    const columns = Array.from({ length: 12 }, (_, bin) => ({ side: sideOf(bin, 12), column: columnOf(bin, 12) }));
    const inOrder = columns.sort((a, b) => a.column - b.column).map(({ side }) => side);
    expect(inOrder.join(' ')).toBe(
      'medial medial medial superior superior superior lateral lateral lateral inferior inferior inferior',
    );
  });

  it('counts bins that were touched, not how often', () => {
    const samples = new Array<number>(24).fill(0);
    samples[0] = 500; // depth 0, medial
    samples[12 + 3] = 1; // depth 1, superior
    const sides = coveredBySide({ depthBins: 2, angleBins: 12, samples });
    expect(sides.medial).toEqual({ touched: 1, bins: 6 });
    expect(sides.superior).toEqual({ touched: 1, bins: 6 });
    expect(sides.lateral.touched + sides.inferior.touched).toBe(0);
  });

  it('colours what was touched once, and what was touched most, and nothing else', () => {
    expect(heatOf(0, 100)).toBe(0);
    expect(heatOf(1, 1_000_000)).toBe(1);
    expect(heatOf(100, 100)).toBe(5);
    const cells = heatPaths({ depthBins: 2, angleBins: 4, samples: [0, 1, 0, 0, 0, 0, 0, 9] }).map(
      (path) => path.split('M').length - 1,
    );
    expect(cells.reduce((a, b) => a + b)).toBe(8);
    expect(cells[0]).toBe(6);
  });
});

describe('the CT on the cut', () => {
  it('is the mean of its neighbours halfway between, through turned axes', () => {
    // i runs along −x: the grid's second voxel lies at x = −2 mm.
    const bone = {
      dims: [2, 2, 2] as const,
      spacing_m: [0.002, 0.002, 0.002] as const,
      origin_m: [0, 0, 0] as const,
      directions: [-1, 0, 0, 0, 1, 0, 0, 0, 1],
      opacity: Uint8Array.from([0, 200, 0, 200, 0, 200, 0, 200]),
    };
    expect(opacityAt(bone, [-0.001, 0.001, 0.001])).toBeCloseTo(100, 9);
    expect(opacityAt(bone, [-0.0005, 0.0004, 0.0013])).toBeCloseTo(50, 9);
    expect(opacityAt(bone, [0.001, 0.001, 0.001]), 'outside').toBe(0);
  });
});

describe('the scale of force against depth', () => {
  const across = scaleLinear([0, 0.05], [50, 550]);
  const up = scaleLinear([0, 100], [300, 0]);

  it('puts the path through the points that are numbers', () => {
    expect(linePath([0, 0.05], [0, 100], across, up)).toBe('M50 300L550 0');
    expect(linePath([0, Number.NaN, 0.05], [0, 5, 100], across, up)).toBe('M50 300L550 0');
  });

  it('has round ticks, no more than fit', () => {
    const texts = (to: number, most: number) => ticksOf(scaleLinear([0, to], [0, 1]), most).map(({ text }) => text);
    expect(texts(48, 6)).toEqual(['0', '10', '20', '30', '40']);
    expect(texts(0.9, 5)).toEqual(['0.0', '0.2', '0.4', '0.6', '0.8']);
    for (let most = 2; most < 12; ++most)
      for (let to = 0.013; to < 2e4; to *= 1.37) expect(texts(to, most).length).toBeLessThanOrEqual(most + 1);
  });

  it('has a label on a lonely tick', () => {
    expect(ticksOf(scaleLinear([0.37, 0.37], [0, 1]), 4)).toEqual([{ at: 0.37, text: '0.37' }]);
  });

  it('marks decades of a logarithmic axis, and parts of them where there is room', () => {
    const texts = (from: number, to: number, most: number) =>
      ticks({ title: '', from, to, log: true }, most).map(({ text }) => text);
    expect(texts(0.02, 2000, 5)).toEqual(['0.1', '1', '10', '100', '1000']);
    expect(texts(1e-6, 1e6, 5)).toEqual(['0.000001', '0.0001', '0.01', '1', '100', '10000', '1000000']);
    expect(texts(0.5, 15, 9)).toEqual(['1', '2', '3', '10']);
  });

  it('has at least three ticks on a low axis of depth', () => {
    for (const deepest_mm of [8, 29, 42, 63, 99])
      expect(ticks({ title: '', from: 0, to: deepest_mm }, mostTicks(170)).length).toBeGreaterThanOrEqual(3);
  });

  it('finds the point under the pointer on the picture, not in the data', () => {
    expect(nearestPoint([0, 0.025, 0.05], [0, 50, 100], across, up, 310, 160)).toBe(1);
    expect(nearestPoint([], [], across, up, 0, 0)).toBe(-1);
  });
});
