/** CT volumes: brought, looked at, released or refused. */
import { address } from './address';
import { requestJson, sendFile } from './client';
import { sourceVolumeSchema } from './teaching-schemas';

const posted = { method: 'POST' } as const;

/** @param onShare  called with the share of the file that has gone, 0 to 1 */
export const addVolume = (name: string, source: string, file: Blob, onShare: (share: number) => void) =>
  sendFile(`/volumes?${new URLSearchParams({ name, source })}`, sourceVolumeSchema, file, onShare);
export const releaseVolume = (id: string) =>
  requestJson(address('/api/v1/volumes/{id}/release', { id }), sourceVolumeSchema, {
    ...posted,
    body: { looked_at: true },
  });
export const refuseVolume = (id: string, reason: string) =>
  requestJson(address('/api/v1/volumes/{id}/refuse', { id }), sourceVolumeSchema, { ...posted, body: { reason } });
