/** Learning platforms (LTI 1.3) and the learning record store (xAPI), for administrators. */
import { queryOptions } from '@tanstack/react-query';
import * as v from 'valibot';
import { address } from './address';
import { request, requestJson } from './client';
import { inUtc } from './quantities';

export const ltiPlatformSchema = v.object({
  id: v.string(),
  issuer: v.string(),
  client_id: v.string(),
  deployments: v.array(v.string()),
  authorization_url: v.string(),
  token_url: v.string(),
  keys_url: v.string(),
  match_email: v.boolean(),
  made_utc_us: inUtc,
  made_by: v.string(),
});
export const ltiPlatformsSchema = v.object({
  platforms: v.array(ltiPlatformSchema),
  login_url: v.string(),
  launch_url: v.string(),
  keys_url: v.string(),
});
export const recordStoreSchema = v.object({
  store: v.nullable(v.object({ endpoint: v.string(), key: v.string(), made_utc_us: inUtc, made_by: v.string() })),
});
export type LtiPlatform = v.InferOutput<typeof ltiPlatformSchema>;
export type NewLtiPlatform = Omit<LtiPlatform, 'id' | 'made_utc_us' | 'made_by'>;
export type LtiPlatforms = v.InferOutput<typeof ltiPlatformsSchema>;

export const ltiPlatformsQuery = queryOptions({
  queryKey: ['lti', 'platforms'],
  queryFn: ({ signal }) => requestJson(address('/api/v1/lti/platforms', {}), ltiPlatformsSchema, { signal }),
});
export const recordStoreQuery = queryOptions({
  queryKey: ['record-store'],
  queryFn: ({ signal }) => requestJson(address('/api/v1/record-store', {}), recordStoreSchema, { signal }),
});

const posted = { method: 'POST' } as const;
export const addLtiPlatform = (wish: NewLtiPlatform) =>
  requestJson(address('/api/v1/lti/platforms', {}), ltiPlatformSchema, { ...posted, body: wish });
export const removeLtiPlatform = (id: string) =>
  request(`/lti/platforms/${encodeURIComponent(id)}`, { method: 'DELETE' });
export const linkLtiPerson = ({
  id,
  ...wish
}: {
  readonly id: string;
  readonly account: string;
  readonly subject: string;
}) => request(address('/api/v1/lti/platforms/{id}/people', { id }), { ...posted, body: wish });
export const setRecordStore = (wish: { readonly endpoint: string; readonly key: string; readonly secret: string }) =>
  requestJson(address('/api/v1/record-store', {}), recordStoreSchema, { ...posted, body: wish });
export const removeRecordStore = () => request('/record-store', { method: 'DELETE' });
