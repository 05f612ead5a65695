/** Backups on the server: made while it serves, tried by restoring them. */
import { queryOptions } from '@tanstack/react-query';
import * as v from 'valibot';
import { address } from './address';
import { requestJson } from './client';
import { count, inUtc } from './quantities';

export const backupSchema = v.object({
  id: v.string(),
  state: v.picklist(['making', 'verifying', 'done', 'failed']),
  share: v.number(),
  error: v.string(),
  made_utc_us: inUtc,
  made_by: v.string(),
  size_bytes: count,
  trials: count,
  verified: v.nullable(v.object({ holds: v.boolean(), at_utc_us: inUtc, findings: v.array(v.string()) })),
});
export const backupListSchema = v.object({ backups: v.array(backupSchema) });
export type Backup = v.InferOutput<typeof backupSchema>;

const kWorking_ms = 700,
  kIdle_ms = 30_000;

export const backupsQuery = queryOptions({
  queryKey: ['backups'],
  queryFn: ({ signal }) => requestJson(address('/api/v1/backups', {}), backupListSchema, { signal }),
  refetchInterval: (query) =>
    query.state.data?.backups.some(({ state }) => state === 'making' || state === 'verifying') ? kWorking_ms : kIdle_ms,
});
export const makeBackup = () => requestJson(address('/api/v1/backups', {}), backupSchema, { method: 'POST' });
export const verifyBackup = (id: string) =>
  requestJson(address('/api/v1/backups/{id}/verify', { id }), backupSchema, { method: 'POST' });
