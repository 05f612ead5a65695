import { useEffect, useState } from 'react';
import { listenLive, type LineState, type LiveMessage, type StationState } from '@/api';

export interface Live { readonly line: LineState; readonly stations: readonly StationState[] | null }

/** One message taken in: all stations anew, or one that changed. */
export function taken(stations: readonly StationState[] | null, message: LiveMessage): readonly StationState[] {
  if (message.kind === 'stations') return message.stations;
  const { station } = message;
  const known = stations ?? [];
  return known.some(({ id }) => id === station.id) ? known.map((one) => (one.id === station.id ? station : one)) : [...known, station];
}

/** The stations as they are, while the page is open. What was last known stays while the line is lost. Drawn at most once a frame. */
export function useLive(): Live {
  const [live, setLive] = useState<Live>({ line: 'connecting', stations: null });
  useEffect(() => {
    let waiting: LiveMessage[] = [];
    let frame = 0;
    const draw = () => {
      frame = 0;
      const came = waiting;
      waiting = [];
      setLive(({ line, stations }) => ({ line, stations: came.reduce<readonly StationState[] | null>(taken, stations) }));
    };
    const end = listenLive({
      onLine: (line) => setLive(({ stations }) => ({ line, stations })),
      onMessage: (message) => { waiting.push(message); if (frame === 0) frame = requestAnimationFrame(draw); },
    });
    return () => { end(); cancelAnimationFrame(frame); };
  }, []);
  return live;
}
