/** A person's own data, people who leave, and the rules by which data are kept. */
import { queryOptions } from '@tanstack/react-query';
import * as v from 'valibot';
import { address } from './address';
import { requestJson } from './client';
import { count, inUtc } from './quantities';

/** Of the downloads, for links. */
export const ownDataAddress = `/api/v1${address('/api/v1/session/data', {})}`;
export const dataOfAccountAddress = (id: string) => `/api/v1${address('/api/v1/accounts/{id}/data', { id })}`;

const mode = v.picklist(['erase', 'anonymise']);
export type ErasureMode = v.InferOutput<typeof mode>;

export const erasurePreviewSchema = v.object({
  name: v.string(),
  mode,
  alias: v.string(),
  tables: v.array(
    v.object({
      table: v.string(),
      what: v.string(),
      fate: v.picklist(['removed', 'changed', 'kept', 'none']),
      rows: count,
      reason: v.string(),
    }),
  ),
  files: count,
  file_bytes: count,
  open_uploads: count,
});
export type ErasurePreview = v.InferOutput<typeof erasurePreviewSchema>;

export const erasureSchema = v.object({
  number: count,
  alias: v.string(),
  mode,
  cause: v.picklist(['asked', 'retention', 'restored']),
  state: v.picklist(['begun', 'done']),
  begun_utc_us: inUtc,
});
export type Erasure = v.InferOutput<typeof erasureSchema>;

export const erasurePreviewQuery = (id: string, how: ErasureMode) =>
  queryOptions({
    queryKey: ['erasure', id, how],
    queryFn: ({ signal }) =>
      requestJson(address('/api/v1/accounts/{id}/erasure', { id }, { mode: how }), erasurePreviewSchema, { signal }),
    staleTime: 0,
  });
export const eraseAccount = (id: string, how: ErasureMode, name: string) =>
  requestJson(address('/api/v1/accounts/{id}/erasure', { id }), erasureSchema, {
    method: 'POST',
    body: { mode: how, name },
  });

export const retentionEffectSchema = v.object({
  people: v.array(
    v.object({ id: v.string(), name: v.string(), last_utc_us: inUtc, noticed: v.boolean(), acts_utc_us: inUtc }),
  ),
  sign_ins: count,
});
export type RetentionEffect = v.InferOutput<typeof retentionEffectSchema>;

const rules = {
  inactive_years: v.nullable(count),
  inactive_mode: mode,
  sign_ins_months: v.nullable(count),
  notice_days: count,
};
export interface RetentionRules {
  readonly inactive_years: number | null;
  readonly inactive_mode: ErasureMode;
  readonly sign_ins_months: number | null;
  readonly notice_days: number;
}
export const retentionSchema = v.object({
  versions: v.array(
    v.object({ ...rules, version: count, reason: v.string(), made_utc_us: inUtc, made_by: v.string() }),
  ),
  effect: retentionEffectSchema,
});
export type RetentionVersion = v.InferOutput<typeof retentionSchema>['versions'][number];

export const retentionQuery = queryOptions({
  queryKey: ['retention'],
  queryFn: ({ signal }) => requestJson(address('/api/v1/retention', {}), retentionSchema, { signal }),
});
export const previewRetention = (asked: RetentionRules) =>
  requestJson(address('/api/v1/retention/preview', {}), retentionEffectSchema, { method: 'POST', body: asked });
export const setRetention = (asked: RetentionRules, reason: string) =>
  requestJson(address('/api/v1/retention', {}), retentionSchema, { method: 'POST', body: { ...asked, reason } });
