/** What passing is, who has passed, and curricula. */
import { queryOptions } from '@tanstack/react-query';
import { address } from './address';
import { requestJson } from './client';
import {
  criteriaListSchema,
  curriculaSchema,
  curriculumPeopleSchema,
  expertBoundSchema,
  passingSchema,
  type BoundMethod,
} from './criteria-schemas';
import type { components } from './generated/schema';
import type { Release } from './teaching-schemas';

export { kBoundMethods } from './criteria-schemas';

/** A requirement as the server takes it; the rest of its fields are of its kind. */
export type NewRequirement = Readonly<Record<string, string | number>>;
export type NewCriteria = components['schemas']['CriteriaFile'];
export const criteriaOf = (requirements: readonly NewRequirement[]): NewCriteria => ({
  format: 'tractus-criteria/1',
  requirements: [...requirements] as NewCriteria['requirements'],
});

const posted = { method: 'POST' } as const;

export const criteriaQuery = queryOptions({
  queryKey: ['criteria'],
  queryFn: ({ signal }) => requestJson(address('/api/v1/criteria', {}), criteriaListSchema, { signal }),
});
export const addCriteria = (
  of: { readonly case?: string; readonly assignment?: string },
  criteria: NewCriteria,
  reason: string,
) => requestJson(address('/api/v1/criteria', {}), criteriaListSchema, { ...posted, body: { ...of, criteria, reason } });

export const passingQuery = (kind: 'case' | 'assignment', id: string) =>
  queryOptions({
    queryKey: ['passing', kind, id],
    queryFn: ({ signal }) =>
      requestJson(
        kind === 'case'
          ? address('/api/v1/cases/{id}/passing', { id })
          : address('/api/v1/assignments/{id}/passing', { id }),
        passingSchema,
        { signal },
      ),
  });

export interface BoundRequest {
  readonly metric: string;
  readonly side: 'at_most' | 'at_least';
  readonly method: BoundMethod;
  readonly experts: string;
  readonly novices: string;
  readonly k: number;
  readonly share: number;
}
export const expertBoundQuery = (of: BoundRequest) =>
  queryOptions({
    queryKey: ['expert-bound', of],
    queryFn: ({ signal }) => {
      const { novices, ...rest } = of;
      return requestJson(
        address('/api/v1/criteria/bound', {}, { ...rest, ...(novices === '' ? {} : { novices }) }),
        expertBoundSchema,
        { signal },
      );
    },
    enabled: of.experts !== '' && (of.method !== 'youden' || of.novices !== ''),
    retry: false,
  });

export const curriculaQuery = queryOptions({
  queryKey: ['curricula'],
  queryFn: ({ signal }) => requestJson(address('/api/v1/curricula', {}), curriculaSchema, { signal }),
});
export type NewCurriculum = components['schemas']['NewCurriculum'];
export const addCurriculum = (curriculum: NewCurriculum) =>
  requestJson(address('/api/v1/curricula', {}), curriculaSchema, { ...posted, body: curriculum });
export const curriculumProgressQuery = (id: string) =>
  queryOptions({
    queryKey: ['curricula', id],
    queryFn: ({ signal }) =>
      requestJson(address('/api/v1/curricula/{id}/progress', { id }), curriculumPeopleSchema, { signal }),
  });
export const ownCurriculaQuery = (account: string) =>
  queryOptions({
    queryKey: ['curricula-of', account],
    queryFn: ({ signal }) =>
      requestJson(address('/api/v1/accounts/{id}/curricula', { id: account }), curriculumPeopleSchema, { signal }),
  });
export const giveCurriculum = (id: string, cohort: string, release: Release, due_utc_us: number | null) =>
  requestJson(address('/api/v1/curricula/{id}/cohorts', { id }), curriculumPeopleSchema, {
    ...posted,
    body: { cohort, release, ...(due_utc_us === null ? {} : { due_utc_us }) },
  });
export const repeatStep = (id: string, account: string, step: string) =>
  requestJson(
    address('/api/v1/curricula/{id}/people/{account_id}/again', { id, account_id: account }),
    curriculumPeopleSchema,
    { ...posted, body: { step } },
  );
