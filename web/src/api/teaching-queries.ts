/** Teaching: making cases and scenarios, assigning them, talking about what came of it. */
import { queryOptions, keepPreviousData } from '@tanstack/react-query';
import { address } from './address';
import { requestJson, bytes, request } from './client';
import type { components } from './generated/schema';
import { everyRow, kMostRows, kRowsPerPage, type AssignmentsAsked, type CasesAsked } from './lists';
import { parsePreview } from './preview';
import { parseSlice, type SlicePlane } from './slices';
import {
  assignmentListSchema,
  assignmentSchema,
  caseListSchema,
  caseManifestSchema,
  caseTruthSchema,
  certificateSchema,
  commentListSchema,
  makingListSchema,
  makingSchema,
  plannedCertificateSchema,
  plannedTractSchema,
  referenceListSchema,
  referenceWaySchema,
  scenarioCheckSchema,
  scenarioFileSchema,
  scenarioListSchema,
  scenarioVersionSchema,
  sourceVolumeListSchema,
  type Release,
} from './teaching-schemas';

export type TractRequest = components['schemas']['TractWish'];
export type NewCase = components['schemas']['NewCase'];
export type NewAssignment = components['schemas']['NewAssignment'];

const kLive_ms = 5_000,
  kMaking_ms = 700;
const kSide_px = 512,
  kBlock = 128;
/** CT values between which bone goes from clear to opaque, as the palpation model's own transfer function has it. */
const kBone = { low: 150, high: 700 };
const posted = { method: 'POST' } as const;

export const sourceVolumesQuery = queryOptions({
  queryKey: ['source-volumes'],
  queryFn: ({ signal }) => requestJson('/volumes', sourceVolumeListSchema, { signal }),
});

export interface Window {
  readonly low: number;
  readonly high: number;
}

export const sliceQuery = (volume: string, plane: SlicePlane, at_m: number, { low, high }: Window) =>
  queryOptions({
    queryKey: ['slice', volume, plane, at_m, low, high],
    queryFn: async ({ signal }) => {
      const query = new URLSearchParams({
        axis: plane,
        at_m: String(at_m),
        max_side: String(kSide_px),
        low: String(low),
        high: String(high),
      });
      const { headers, data } = await bytes(`/volumes/${encodeURIComponent(volume)}/slice?${query}`, { signal });
      return parseSlice(headers, data);
    },
    staleTime: Infinity,
    gcTime: 60_000,
    placeholderData: keepPreviousData,
  });

export const volumeBoneQuery = (volume: string) =>
  queryOptions({
    queryKey: ['volume-bone', volume],
    queryFn: async ({ signal }) => {
      const query = new URLSearchParams({ max_side: String(kBlock), low: String(kBone.low), high: String(kBone.high) });
      const { headers, data } = await bytes(`/volumes/${encodeURIComponent(volume)}/preview?${query}`, {
        signal,
        timeout_ms: 60_000,
      });
      return parsePreview(headers, data);
    },
    staleTime: Infinity,
  });

export const plannedTractQuery = (volume: string, request: TractRequest | null) =>
  queryOptions({
    queryKey: ['planned-tract', volume, request],
    queryFn: ({ signal }) =>
      requestJson(address('/api/v1/volumes/{id}/tract', { id: volume }), plannedTractSchema, {
        ...posted,
        body: request,
        signal,
        timeout_ms: 60_000,
      }),
    enabled: request !== null,
    staleTime: Infinity,
    placeholderData: keepPreviousData,
  });

/** The server calls off an older question of the same person: then the tract was moved, and nobody waits for it. */
export const plannedCertificateQuery = (volume: string, request: TractRequest | null, effort: 'first' | 'whole') =>
  queryOptions({
    queryKey: ['planned-certificate', volume, request, effort],
    queryFn: ({ signal }) =>
      requestJson(address('/api/v1/volumes/{id}/certificate', { id: volume }), plannedCertificateSchema, {
        ...posted,
        body: { ...request, effort },
        signal,
        timeout_ms: 120_000,
      }),
    enabled: request !== null,
    staleTime: Infinity,
    retry: false,
  });

const cases = (asked: CasesAsked, limit: number, signal: AbortSignal) =>
  requestJson(address('/api/v1/cases', {}, { ...asked, limit }), caseListSchema, { signal });
/** A page of the cases. */
export const casesQuery = (asked: CasesAsked) =>
  queryOptions({
    queryKey: ['cases', 'page', asked],
    queryFn: ({ signal }) => cases(asked, kRowsPerPage, signal),
    placeholderData: keepPreviousData,
  });
/** All cases, newest first. Its key begins those of the pages. */
export const allCasesQuery = queryOptions({
  queryKey: ['cases'],
  queryFn: async ({ signal }) => ({
    cases: await everyRow(async (cursor) => {
      const { cases: rows, next } = await cases({ cursor }, kMostRows, signal);
      return { rows, next };
    }),
  }),
});
export const caseQuery = (id: string) =>
  queryOptions({
    queryKey: ['case', id],
    queryFn: ({ signal }) => requestJson(address('/api/v1/cases/{id}', { id }), caseManifestSchema, { signal }),
    staleTime: Infinity,
  });
export const caseTruthQuery = (id: string) =>
  queryOptions({
    queryKey: ['case-truth', id],
    queryFn: ({ signal }) =>
      requestJson(address('/api/v1/cases/{id}/parts/{name}', { id, name: 'truth.json' }), caseTruthSchema, { signal }),
    staleTime: Infinity,
  });
export const caseCertificateQuery = (id: string) =>
  queryOptions({
    queryKey: ['case-certificate', id],
    queryFn: ({ signal }) =>
      requestJson(address('/api/v1/cases/{id}/parts/{name}', { id, name: 'certificate.json' }), certificateSchema, {
        signal,
      }),
    staleTime: Infinity,
    retry: false,
  });
export const makeCase = (newCase: NewCase) =>
  requestJson(address('/api/v1/cases', {}), makingSchema, { ...posted, body: newCase });
export const retireCase = (id: string, retired: boolean) =>
  request(address('/api/v1/cases/{id}/retire', { id }), { ...posted, body: { retired } });

const going = (state: string | undefined) => state === 'queued' || state === 'running';
export const makingsQuery = queryOptions({
  queryKey: ['case-makings'],
  queryFn: ({ signal }) => requestJson(address('/api/v1/case-makings', {}), makingListSchema, { signal }),
  refetchInterval: (query) => (query.state.data?.makings.some(({ state }) => going(state)) ? kMaking_ms : false),
});
export const makingQuery = (id: string) =>
  queryOptions({
    queryKey: ['case-makings', id],
    queryFn: ({ signal }) => requestJson(address('/api/v1/case-makings/{id}', { id }), makingSchema, { signal }),
    refetchInterval: (query) => (going(query.state.data?.state) ? kMaking_ms : false),
  });

export const scenariosQuery = queryOptions({
  queryKey: ['scenarios'],
  queryFn: ({ signal }) => requestJson(address('/api/v1/scenarios', {}), scenarioListSchema, { signal }),
});
export const scenarioFileQuery = (id: string) =>
  queryOptions({
    queryKey: ['scenarios', id],
    queryFn: ({ signal }) => requestJson(address('/api/v1/scenarios/{id}', { id }), scenarioFileSchema, { signal }),
    staleTime: Infinity,
  });
export const scenarioCheckQuery = (draft: Record<string, unknown> | null) =>
  queryOptions({
    queryKey: ['scenario-check', draft],
    queryFn: ({ signal }) =>
      requestJson(address('/api/v1/scenarios/check', {}), scenarioCheckSchema, { ...posted, body: draft, signal }),
    enabled: draft !== null,
    staleTime: Infinity,
    placeholderData: keepPreviousData,
  });
export const addScenario = (scenario: Record<string, unknown>, parent: string, publish: boolean) =>
  requestJson(address('/api/v1/scenarios', {}), scenarioVersionSchema, {
    ...posted,
    body: { scenario, parent, publish },
  });
export const publishScenario = (id: string, published: boolean) =>
  requestJson(address('/api/v1/scenarios/{id}/publish', { id }), scenarioVersionSchema, {
    ...posted,
    body: { published },
  });

const assignments = (asked: AssignmentsAsked, limit: number, signal: AbortSignal) =>
  requestJson(address('/api/v1/assignments', {}, { ...asked, limit }), assignmentListSchema, { signal });
/** Keys of what lists assignments begin so; that of a single assignment does not. */
export const kAssignmentLists = ['assignment-lists'] as const;
/** A page of the assignments: usually the unfinished ones first, the earliest due first. */
export const assignmentsQuery = (asked: AssignmentsAsked) =>
  queryOptions({
    queryKey: [...kAssignmentLists, asked],
    queryFn: ({ signal }) => assignments(asked, kRowsPerPage, signal),
    placeholderData: keepPreviousData,
    refetchInterval: kLive_ms,
  });
/** All assignments, in the same order. */
export const allAssignmentsQuery = queryOptions({
  queryKey: [...kAssignmentLists, 'all'],
  queryFn: async ({ signal }) => ({
    assignments: await everyRow(async (cursor) => {
      const { assignments: rows, next } = await assignments({ cursor }, kMostRows, signal);
      return { rows, next };
    }),
  }),
  refetchInterval: kLive_ms,
});
export const assignmentQuery = (id: string) =>
  queryOptions({
    queryKey: ['assignments', id],
    queryFn: ({ signal }) => requestJson(address('/api/v1/assignments/{id}', { id }), assignmentSchema, { signal }),
    refetchInterval: kLive_ms,
  });
const changed = (path: string, body: unknown) => requestJson(path, assignmentSchema, { ...posted, body });
export const addAssignment = (request: NewAssignment) => changed(address('/api/v1/assignments', {}), request);
export const setRelease = (id: string, release: Release) =>
  changed(address('/api/v1/assignments/{id}/release', { id }), { release });
export const setDue = (id: string, due_utc_us: number | null) =>
  changed(address('/api/v1/assignments/{id}/due', { id }), { due_utc_us });
export const assignPerson = (id: string, name: string) =>
  changed(address('/api/v1/assignments/{id}/people', { id }), { name });
export const releaseReservation = (id: string, account: string) =>
  changed(address('/api/v1/assignments/{id}/people/{account_id}/free', { id, account_id: account }), {});
export const markAssignedInvalid = (id: string, trial: string, reason: string) =>
  changed(address('/api/v1/assignments/{id}/trials/{trial_id}/invalid', { id, trial_id: trial }), { reason });

export const commentsQuery = (trial: string) =>
  queryOptions({
    queryKey: ['comments', trial],
    queryFn: ({ signal }) =>
      requestJson(address('/api/v1/trials/{id}/comments', { id: trial }), commentListSchema, { signal }),
  });
export const addComment = (trial: string, at_s: number | null, text: string) =>
  requestJson(address('/api/v1/trials/{id}/comments', { id: trial }), commentListSchema, {
    ...posted,
    body: { at_s, text },
  });
export const removeComment = (trial: string, comment: string) =>
  requestJson(`/trials/${encodeURIComponent(trial)}/comments/${encodeURIComponent(comment)}`, commentListSchema, {
    method: 'DELETE',
  });
export const referencesQuery = (trial: string) =>
  queryOptions({
    queryKey: ['references', trial],
    queryFn: ({ signal }) =>
      requestJson(address('/api/v1/trials/{id}/references', { id: trial }), referenceListSchema, { signal }),
  });
export const setReference = (trial: string, reference: boolean) =>
  requestJson(address('/api/v1/trials/{id}/reference', { id: trial }), referenceListSchema, {
    ...posted,
    body: { reference },
  });
export const referenceWayQuery = (trial: string, reference: string) =>
  queryOptions({
    queryKey: ['reference-way', trial, reference],
    queryFn: ({ signal }) =>
      requestJson(address('/api/v1/trials/{id}/references/{reference}', { id: trial, reference }), referenceWaySchema, {
        signal,
      }),
    staleTime: Infinity,
  });
