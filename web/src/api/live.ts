/** Stations live: a socket that comes back by itself, one station's page, and what can be asked of a station. */
import { queryOptions } from '@tanstack/react-query';
import * as v from 'valibot';
import { ask, tell } from './client';
import { liveMessageSchema, stationPageSchema, type LiveMessage } from './live-schemas';

/** connecting: never was there yet; lost: was, and is tried again. */
export type LineState = 'connecting' | 'open' | 'lost';
interface Listener { readonly onLine: (state: LineState) => void; readonly onMessage: (message: LiveMessage) => void }

const kFirstWait_ms = 500, kLongestWait_ms = 15_000;

/** Listens until the answer is called. A message of another kind is passed over. */
export function listenLive({ onLine, onMessage }: Listener, open: (url: string) => WebSocket = (url) => new WebSocket(url)): () => void {
  let ended = false, was = false, wait_ms = kFirstWait_ms;
  let socket: WebSocket | undefined;
  let timer: ReturnType<typeof setTimeout> | undefined;
  const begin = () => {
    onLine(was ? 'lost' : 'connecting');
    const line = open(`${window.location.protocol === 'https:' ? 'wss' : 'ws'}://${window.location.host}/api/v1/live`);
    socket = line;
    line.onopen = () => { was = true; wait_ms = kFirstWait_ms; onLine('open'); };
    line.onmessage = ({ data }: MessageEvent<unknown>) => {
      if (typeof data !== 'string') return;
      const read = v.safeParse(v.pipe(v.string(), v.parseJson(), liveMessageSchema), data);
      if (read.success) onMessage(read.output);
    };
    line.onclose = () => {
      if (ended) return;
      onLine(was ? 'lost' : 'connecting');
      timer = setTimeout(begin, wait_ms);
      wait_ms = Math.min(2 * wait_ms, kLongestWait_ms);
    };
  };
  begin();
  return () => { ended = true; clearTimeout(timer); socket?.close(); };
}

const station = (id: string, tail = '') => `/stations/${encodeURIComponent(id)}${tail}`;
export const stationQuery = (id: string) =>
  queryOptions({ queryKey: ['stations', id], queryFn: ({ signal }) => ask(station(id), stationPageSchema, { signal }), refetchInterval: 15_000 });
/** Zero force at once; then it waits for a person at the station. */
export const stopStation = (id: string, reason: string) => tell(station(id, '/stop'), { method: 'POST', body: { reason } });
/** The server may lower a station's limit, never raise it. */
export const limitStation = (id: string, force_N: number) => tell(station(id, '/limits'), { method: 'POST', body: { force_N } });
