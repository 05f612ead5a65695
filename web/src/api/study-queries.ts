/** Queries and actions of studies. */
import { queryOptions } from '@tanstack/react-query';
import { address } from './address';
import { requestJson } from './client';
import type { components } from './generated/schema';
import { studyEventsSchema, studyListSchema, studySchema, type Study, type StudyState } from './study-schemas';

/** Refetch interval of the pages of studies. */
const kLive_ms = 2_000;
const kEvents = 50;

export type NewStudy = components['schemas']['NewStudy'];
export type NewParticipant = components['schemas']['NewParticipant'];

export const studiesQuery = queryOptions({
  queryKey: ['studies'],
  queryFn: ({ signal }) => requestJson(address('/api/v1/studies', {}), studyListSchema, { signal }),
  refetchInterval: kLive_ms,
});

export const studyQuery = (id: string) =>
  queryOptions({
    queryKey: ['study', id],
    queryFn: ({ signal }) => requestJson(address('/api/v1/studies/{id}', { id }), studySchema, { signal }),
    refetchInterval: kLive_ms,
  });

export const studyEventsQuery = (id: string) =>
  queryOptions({
    queryKey: ['study-events', id],
    queryFn: ({ signal }) =>
      requestJson(address('/api/v1/studies/{id}/events', { id }, { limit: kEvents }), studyEventsSchema, { signal }),
    refetchInterval: kLive_ms,
  });

const changedStudy = (path: string, body: unknown): Promise<Study> =>
  requestJson(path, studySchema, { method: 'POST', body });

export const makeStudy = (study: NewStudy) => changedStudy(address('/api/v1/studies', {}), study);
export const enrol = (id: string, participant: NewParticipant) =>
  changedStudy(address('/api/v1/studies/{id}/participants', { id }), participant);
export const setStudyState = (id: string, state: StudyState, reason: string) =>
  changedStudy(address('/api/v1/studies/{id}/state', { id }), { state, reason });
export const setParticipantState = (id: string, name: string, state: StudyState, reason: string) =>
  changedStudy(address('/api/v1/studies/{id}/participants/{name}/state', { id, name }), { state, reason });
export const releaseParticipant = (id: string, name: string, reason: string) =>
  changedStudy(address('/api/v1/studies/{id}/participants/{name}/release', { id, name }), { reason });
export const markTrialInvalid = (id: string, trial: string, reason: string) =>
  changedStudy(address('/api/v1/studies/{id}/trials/{trial_id}/invalid', { id, trial_id: trial }), { reason });
