/** Ratings of trials by people. */
import { queryOptions } from '@tanstack/react-query';
import { address } from './address';
import { requestJson } from './client';
import {
  agreementSchema,
  ratingRequestListSchema,
  rubricListSchema,
  trialRatingsSchema,
  type RubricItem,
} from './rating-schemas';

const posted = { method: 'POST' } as const;

export const rubricsQuery = queryOptions({
  queryKey: ['rubrics'],
  queryFn: ({ signal }) => requestJson(address('/api/v1/rubrics', {}), rubricListSchema, { signal }),
});
/** Makes the rubric, or its next version. */
export const addRubric = (id: string, title: string, items: readonly RubricItem[], reason: string) =>
  requestJson(address('/api/v1/rubrics', {}), rubricListSchema, {
    ...posted,
    body: { id, reason, rubric: { format: 'tractus-rubric/1', title, items } },
  });

export const ratingRequestsQuery = queryOptions({
  queryKey: ['rating-requests'],
  queryFn: ({ signal }) => requestJson(address('/api/v1/ratings', {}), ratingRequestListSchema, { signal }),
});
export const agreementQuery = (rubric: string, version: number) =>
  queryOptions({
    queryKey: ['rating-agreement', rubric, version],
    queryFn: ({ signal }) =>
      requestJson(address('/api/v1/ratings/agreement', {}, { rubric, version }), agreementSchema, { signal }),
    enabled: rubric !== '',
  });

export const trialRatingsQuery = (trial: string) =>
  queryOptions({
    queryKey: ['trial-ratings', trial],
    queryFn: ({ signal }) =>
      requestJson(address('/api/v1/trials/{id}/ratings', { id: trial }), trialRatingsSchema, { signal }),
  });
export const askForRating = (trial: string, of: { rubric: string; blind: boolean; raters: number }) =>
  requestJson(address('/api/v1/trials/{id}/rating-requests', { id: trial }), trialRatingsSchema, {
    ...posted,
    body: of,
  });
export const withdrawRatingRequest = (trial: string, rubric: string) =>
  requestJson(
    `/trials/${encodeURIComponent(trial)}/rating-requests/${encodeURIComponent(rubric)}`,
    trialRatingsSchema,
    { method: 'DELETE' },
  );
/** `reason`: why the own rating before is superseded; empty for the first. */
export const addRating = (
  trial: string,
  of: { rubric: string; scores: readonly number[]; comment: string; reason: string },
) => requestJson(address('/api/v1/trials/{id}/ratings', { id: trial }), trialRatingsSchema, { ...posted, body: of });
