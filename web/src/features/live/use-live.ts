import { useEffect, useState } from 'react';
import { subscribeLive, type ConnectionState, type LiveMessage, type StationState } from '@/api';

export interface Live {
  readonly connection: ConnectionState;
  readonly stations: readonly StationState[] | null;
}

/** One message withMessage in: all stations anew, or one that changed. */
export function withMessage(stations: readonly StationState[] | null, message: LiveMessage): readonly StationState[] {
  if (message.kind === 'stations') return message.stations;
  const { station } = message;
  const known = stations ?? [];
  return known.some(({ id }) => id === station.id)
    ? known.map((one) => (one.id === station.id ? station : one))
    : [...known, station];
}

/** The stations as they are, while the page is open. The last known state stays while the connection is lost. Drawn at most once per frame. */
export function useLive(): Live {
  const [live, setLive] = useState<Live>({ connection: 'connecting', stations: null });
  useEffect(() => {
    let waiting: LiveMessage[] = [];
    let frame = 0;
    const draw = () => {
      frame = 0;
      const came = waiting;
      waiting = [];
      setLive(({ connection, stations }) => ({
        connection,
        stations: came.reduce<readonly StationState[] | null>(withMessage, stations),
      }));
    };
    const end = subscribeLive({
      onConnection: (connection) => setLive(({ stations }) => ({ connection, stations })),
      onMessage: (message) => {
        waiting.push(message);
        if (frame === 0) frame = requestAnimationFrame(draw);
      },
    });
    return () => {
      end();
      cancelAnimationFrame(frame);
    };
  }, []);
  return live;
}
