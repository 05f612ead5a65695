/** Live stations: a WebSocket that reconnects, the data of one station, and commands to a station. */
import { queryOptions } from '@tanstack/react-query';
import * as v from 'valibot';
import { requestJson, request } from './client';
import { liveMessageSchema, stationPageSchema, type LiveMessage } from './live-schemas';

/** connecting: not open yet; lost: was open, reconnecting. */
export type ConnectionState = 'connecting' | 'open' | 'lost';
interface Listener {
  readonly onConnection: (state: ConnectionState) => void;
  readonly onMessage: (message: LiveMessage) => void;
}

const kFirstWait_ms = 500,
  kLongestWait_ms = 15_000;

/** Subscribes until the returned function is called. Unknown messages are ignored. */
export function subscribeLive(
  { onConnection, onMessage }: Listener,
  open: (url: string) => WebSocket = (url) => new WebSocket(url),
): () => void {
  let ended = false,
    was = false,
    wait_ms = kFirstWait_ms;
  let socket: WebSocket | undefined;
  let timer: ReturnType<typeof setTimeout> | undefined;
  const begin = () => {
    onConnection(was ? 'lost' : 'connecting');
    const opened = open(
      `${window.location.protocol === 'https:' ? 'wss' : 'ws'}://${window.location.host}/api/v1/live`,
    );
    socket = opened;
    opened.onopen = () => {
      was = true;
      wait_ms = kFirstWait_ms;
      onConnection('open');
    };
    opened.onmessage = ({ data }: MessageEvent<unknown>) => {
      if (typeof data !== 'string') return;
      const read = v.safeParse(v.pipe(v.string(), v.parseJson(), liveMessageSchema), data);
      if (read.success) onMessage(read.output);
    };
    opened.onclose = () => {
      if (ended) return;
      onConnection(was ? 'lost' : 'connecting');
      timer = setTimeout(begin, wait_ms);
      wait_ms = Math.min(2 * wait_ms, kLongestWait_ms);
    };
  };
  begin();
  return () => {
    ended = true;
    clearTimeout(timer);
    socket?.close();
  };
}

const station = (id: string, tail = '') => `/stations/${encodeURIComponent(id)}${tail}`;
export const stationQuery = (id: string) =>
  queryOptions({
    queryKey: ['stations', id],
    queryFn: ({ signal }) => requestJson(station(id), stationPageSchema, { signal }),
    refetchInterval: 15_000,
  });
/** Zero force at once; then it waits for a person at the station. */
export const stopStation = (id: string, reason: string) =>
  request(station(id, '/stop'), { method: 'POST', body: { reason } });
/** The server may lower a station's limit, never raise it. */
export const limitStation = (id: string, force_N: number) =>
  request(station(id, '/limits'), { method: 'POST', body: { force_N } });
