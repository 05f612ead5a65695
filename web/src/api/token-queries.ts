/** Personal API tokens, with which a person's programs call the server. */
import { queryOptions } from '@tanstack/react-query';
import * as v from 'valibot';
import { address } from './address';
import { request, requestJson } from './client';
import { inUtc } from './quantities';

const tokenSchema = v.object({
  id: v.string(),
  name: v.string(),
  owner: v.string(),
  scopes: v.array(v.string()),
  made_utc_us: inUtc,
  expires_utc_us: inUtc,
  used_utc_us: v.nullable(inUtc),
  revoked_utc_us: v.nullable(inUtc),
  revoked_by: v.nullable(v.string()),
});
export const apiTokensSchema = v.object({
  tokens: v.array(tokenSchema),
  scopes: v.array(v.object({ scope: v.string(), meaning: v.string() })),
});
export const apiTokenMadeSchema = v.object({ token: v.string(), entry: tokenSchema });
export type ApiToken = v.InferOutput<typeof tokenSchema>;

export const apiTokensQuery = queryOptions({
  queryKey: ['api-tokens', 'own'],
  queryFn: ({ signal }) => requestJson(address('/api/v1/tokens', {}), apiTokensSchema, { signal }),
});
/** The valid tokens of every account, for administrators. */
export const allApiTokensQuery = queryOptions({
  queryKey: ['api-tokens', 'all'],
  queryFn: ({ signal }) => requestJson(address('/api/v1/accounts/tokens', {}), apiTokensSchema, { signal }),
});

export interface NewApiToken {
  readonly name: string;
  readonly scopes: readonly string[];
  readonly expires_utc_us: number;
  readonly password: string;
  readonly code?: string;
}
export const makeApiToken = (wish: NewApiToken) =>
  requestJson(address('/api/v1/tokens', {}), apiTokenMadeSchema, { method: 'POST', body: wish });
export const revokeApiToken = (id: string) => request(`/tokens/${encodeURIComponent(id)}`, { method: 'DELETE' });
