/** Signing in by a provider of identities: whether this server has one, and where to send the browser. */
import { queryOptions } from '@tanstack/react-query';
import * as v from 'valibot';
import { address } from './address';
import { requestJson } from './client';

export const offerSchema = v.object({ offered: v.boolean(), label: v.nullable(v.string()) });

export const oidcOfferQuery = queryOptions({
  queryKey: ['oidc'],
  queryFn: ({ signal }) => requestJson(address('/api/v1/session/oidc', {}), offerSchema, { signal }),
  staleTime: Infinity,
  retry: false,
});

/** The server answers with the provider's address. */
export const kOidcStart = '/api/v1/session/oidc/start';
