/** All queries, one key each, so that pages share answers. */
import { keepPreviousData, queryOptions, type QueryClient } from '@tanstack/react-query';
import { address } from './address';
import { ApiError, requestJson, bytes, request } from './client';
import { kRowsPerPage, type TrialsAsked } from './lists';
import { parsePreview } from './preview';
import {
  forceDepthSchema,
  pathSchema,
  sessionSchema,
  signalsSchema,
  trialPageSchema,
  trialSchema,
  type Session,
} from './schemas';

const kAssessing_ms = 2_000;
const kIdle_ms = 15_000;
/** Voxels along the longest side; the box round a tract is slender, so that it stays small. */
const kPreview = 128;

export const kChannels = [
  'force_xy_N',
  'force_z_N',
  'torque_xy_Nm',
  'torque_z_Nm',
  'depth_m',
  'offset_m',
  'angle_rad',
] as const;
export const kProbingChannels = ['force_N', 'depth_m', 'speed_m_s', 'angle_rad'] as const;
export type Channel = (typeof kChannels)[number] | (typeof kProbingChannels)[number];

/** null: nobody is signed in. */
export const sessionQuery = queryOptions({
  queryKey: ['session'],
  queryFn: async ({ signal }): Promise<Session | null> => {
    try {
      return await requestJson(address('/api/v1/session', {}), sessionSchema, { signal });
    } catch (reason) {
      if (reason instanceof ApiError && reason.code === 'unauthorised') return null;
      throw reason;
    }
  },
  staleTime: 5 * 60_000,
  retryOnMount: false, // after a failure a person asks again, by the button
});

/** `code`: the one-time code of an account that asks for one. */
export const signIn = (name: string, password: string, code?: string) =>
  requestJson(address('/api/v1/session', {}), sessionSchema, {
    method: 'POST',
    body: { name, password, ...(code === undefined ? {} : { code }) },
  });

export const signOut = () => request(address('/api/v1/session', {}), { method: 'DELETE' });

/** Of the account that is signed in. */
export const setLanguage = (language: string) =>
  request(address('/api/v1/session/language', {}), { method: 'POST', body: { language } });

/** Searched and sorted by the server; refetched while a trial is being assessed, and from time to time for new trials. */
export const trialsQuery = (asked: TrialsAsked) =>
  queryOptions({
    queryKey: ['trials', asked],
    queryFn: ({ signal }) =>
      requestJson(address('/api/v1/trials', {}, { ...asked, limit: kRowsPerPage }), trialPageSchema, { signal }),
    placeholderData: keepPreviousData,
    refetchInterval: (query) =>
      query.state.data?.trials.some((trial) => trial.state === 'assessing') ? kAssessing_ms : kIdle_ms,
  });

export const trialQuery = (id: string) =>
  queryOptions({
    queryKey: ['trial', id],
    queryFn: ({ signal }) => requestJson(address('/api/v1/trials/{id}', { id }), trialSchema, { signal }),
    refetchInterval: (query) => (query.state.data?.state === 'assessing' ? kAssessing_ms : false),
  });

export interface SignalWindow {
  from_s: number;
  to_s: number;
  points: number;
}

/** Signals of a trial never change, so a window once fetched is kept. */
export const signalsQuery = (id: string, channels: readonly Channel[], window: SignalWindow) =>
  queryOptions({
    queryKey: ['signals', id, channels, window],
    queryFn: ({ signal }) => {
      const query = { channels: channels.join(','), ...window };
      return requestJson(address('/api/v1/trials/{id}/signals', { id }, query), signalsSchema, { signal });
    },
    staleTime: Infinity,
  });

export const pathQuery = (id: string) =>
  queryOptions({
    queryKey: ['path', id],
    queryFn: ({ signal }) =>
      requestJson(address('/api/v1/trials/{id}/path', { id }, { points: 2000 }), pathSchema, { signal }),
    staleTime: Infinity,
  });

/** Force against depth of a probing trial, thinned so that no peak is lost. */
export const forceDepthQuery = (id: string) =>
  queryOptions({
    queryKey: ['force-depth', id],
    queryFn: ({ signal }) =>
      requestJson(address('/api/v1/trials/{id}/force-depth', { id }, { points: 2000 }), forceDepthSchema, { signal }),
    staleTime: Infinity,
  });

export const previewQuery = (caseId: string) =>
  queryOptions({
    queryKey: ['preview', caseId],
    queryFn: async ({ signal }) => {
      const { headers, data } = await bytes(
        address('/api/v1/cases/{id}/preview', { id: caseId }, { max_side: kPreview }),
        { signal },
      );
      return parsePreview(headers, data);
    },
    staleTime: Infinity,
  });

/** The session has ended: the sign-in is shown above the page, which stays as it was. */
export function endSession(client: QueryClient): void {
  client.setQueryData(sessionQuery.queryKey, null);
}
