/** Measured and simulated of one channel of one trial, in the detail that a view needs, of both models. */
import { useQueries, useQueryClient } from '@tanstack/react-query';
import { useMemo } from 'react';
import { labSignalsQuery, type LabSignals } from '@/api';
import {
  assemble,
  kNoDetail,
  kTilePoints,
  tileRange,
  tilesFor,
  type Detail,
  type Range,
  type Span,
  type Tile,
} from '@/charts';

export type Side = 'before' | 'after';

/** Series of both sides under one time: measured, before, after, and what each leaves. */
function merged(of: Partial<Record<Side, LabSignals>>): Detail | undefined {
  const first = of.before ?? of.after;
  if (!first) return undefined;
  const channels: Record<string, LabSignals['measured']> = { measured: first.measured };
  for (const side of ['before', 'after'] as const) {
    const signals = of[side];
    if (!signals || signals.t_s.length !== first.t_s.length) continue;
    channels[side] = signals.simulated;
    channels[`${side}_residual`] = signals.residual;
  }
  return { t: first.t_s, channels, samplesPerPoint: first.samples_per_point };
}

/** The size of what is left, for the strip: where along the trial the error is. */
function sizes(detail: Detail): Detail {
  const residual = detail.channels.before_residual ?? detail.channels.after_residual;
  if (!residual) return detail;
  const size = residual.max.map((greatest, i) => Math.max(Math.abs(greatest ?? 0), Math.abs(residual.min[i] ?? 0)));
  return { ...detail, channels: { ...detail.channels, size: { min: size, max: size } } };
}

export interface OverlayView {
  readonly detail: Detail;
  readonly overview: Detail;
  readonly noise_floor: number | null;
  /** Stretches of this trial in each region of the first side. */
  readonly regions: readonly (readonly Span[])[];
  readonly error: Error | null;
  readonly retry: () => void;
}

const kWhole: Tile = { level: 0, index: 0 };

interface OverlayRequest {
  readonly run: string;
  readonly trial: string;
  readonly channel: string;
  readonly duration_s: number;
  readonly sides: readonly Side[];
}

export function useOverlay(
  { run, trial, channel, duration_s, sides }: OverlayRequest,
  range: Range,
  width_px: number,
): OverlayView {
  const client = useQueryClient();
  const queryOf = (tile: Tile, side: Side) => {
    const { from, to } = tileRange(tile, duration_s);
    return labSignalsQuery(run, { trial, channel, side, from_s: from, to_s: to, points: kTilePoints });
  };
  const wholes = useQueries({ queries: sides.map((side) => queryOf(kWhole, side)) });
  const whole = wholes[0]?.data;
  const samples = whole ? whole.t_s.length * Math.max(1, whole.samples_per_point) : kTilePoints;
  const tiles = useMemo(() => tilesFor(range, width_px, duration_s, samples), [range, width_px, duration_s, samples]);
  const finer = tiles.filter((tile) => tile.level > 0).flatMap((tile) => sides.map((side) => queryOf(tile, side)));
  const answers = useQueries({ queries: finer });
  const came = [...wholes, ...answers].map((answer) => answer.dataUpdatedAt).join(' ');
  const sidesKey = sides.join(' ');
  const held = (tile: Tile) => {
    const found: Partial<Record<Side, LabSignals>> = {};
    for (const side of sides) {
      const signals = client.getQueryData(queryOf(tile, side).queryKey);
      if (!signals) return undefined;
      found[side] = signals;
    }
    return merged(found);
  };
  const detail = useMemo(
    () => assemble(tiles, held, duration_s),
    // eslint-disable-next-line react-hooks/exhaustive-deps -- `came` stands for the answers, the other keys for the queries
    [tiles, came, run, trial, channel, sidesKey, duration_s],
  );
  const overview = useMemo(() => {
    const all = held(kWhole);
    return all ? sizes(all) : kNoDetail;
    // eslint-disable-next-line react-hooks/exhaustive-deps -- as above
  }, [came, run, trial, channel, sidesKey, duration_s]);
  const regions = useMemo(
    () => (whole?.regions ?? []).map((stretches) => stretches.map(([from_s, to_s]) => ({ from_s, to_s }))),
    [whole],
  );
  const failed = [...wholes, ...answers].find((answer) => answer.isError);
  return {
    detail,
    overview,
    noise_floor: whole?.noise_floor ?? null,
    regions,
    error: failed?.error ?? null,
    retry: () => {
      for (const answer of [...wholes, ...answers]) if (answer.isError) void answer.refetch();
    },
  };
}
