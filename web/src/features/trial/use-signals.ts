/** The detail that a view needs, fetched tile by tile and put together from the best at hand. */
import { useQueries, useQueryClient } from '@tanstack/react-query';
import { useEffect, useMemo, useRef, useState } from 'react';
import { signalsQuery, type Channel, type Signals, type Trial } from '@/api';
import { assemble, kNoDetail, kTilePoints, tileRange, tilesFor, type Detail, type Range, type Tile } from '@/charts';

const kPace_ms = 80;

function detailOf(signals: Signals): Detail {
  return { t: signals.t_s, channels: signals.channels, samplesPerPoint: signals.samples_per_point };
}

/** Follows a value at a pace at which requests make sense. */
function usePaced<Value>(value: Value): Value {
  const [paced, setPaced] = useState(value);
  const last = useRef(0);
  useEffect(() => {
    const wait = Math.max(0, last.current + kPace_ms - performance.now());
    const timer = setTimeout(() => {
      last.current = performance.now();
      setPaced(value);
    }, wait);
    return () => clearTimeout(timer);
  }, [value]);
  return paced;
}

export interface SignalsView {
  readonly detail: Detail;
  readonly overview: Detail;
  readonly error: Error | null;
  readonly retry: () => void;
}

const kWhole: Tile = { level: 0, index: 0 };

export function useSignals(trial: Trial, channels: readonly Channel[], range: Range, width_px: number): SignalsView {
  const client = useQueryClient();
  const { id, duration_s, samples } = trial;
  const paced = usePaced(range);
  const tiles = useMemo(() => tilesFor(paced, width_px, duration_s, samples), [paced, width_px, duration_s, samples]);
  const queryOf = (tile: Tile) => {
    const { from, to } = tileRange(tile, duration_s);
    return signalsQuery(id, channels, { from_s: from, to_s: to, points: kTilePoints });
  };
  const asked = [kWhole, ...tiles.filter((tile) => tile.level > 0)];
  const answers = useQueries({ queries: asked.map(queryOf) });

  // What has come in, as a key: the detail is assembled anew only when a tile came or the tiles changed.
  const came = answers.map((answer) => answer.dataUpdatedAt).join(' ');
  const detail = useMemo(() => {
    const held = (tile: Tile) => {
      const signals = client.getQueryData(queryOf(tile).queryKey);
      return signals && detailOf(signals);
    };
    return assemble(tiles, held, duration_s);
    // eslint-disable-next-line react-hooks/exhaustive-deps -- `came` stands for the answers, `id` for the query
  }, [tiles, came, client, id, duration_s]);
  const whole = answers[0]?.data;
  const overview = useMemo(() => (whole ? detailOf(whole) : kNoDetail), [whole]);
  const failed = answers.find((answer) => answer.isError);
  return {
    detail,
    overview,
    error: failed?.error ?? null,
    retry: () => {
      for (const answer of answers) if (answer.isError) void answer.refetch();
    },
  };
}
