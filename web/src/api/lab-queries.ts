/** Queries and runs of the model lab. */
import { queryOptions } from '@tanstack/react-query';
import * as v from 'valibot';
import { address } from './address';
import { requestJson } from './client';
import {
  effectCheckSchema,
  effectListSchema,
  labRunListSchema,
  labRunSchema,
  labSignalsSchema,
  measurementListSchema,
  measurementSetSchema,
  modelListSchema,
  modelVersionSchema,
  sentModelSchema,
  type LabRun,
  type Rig,
} from './lab-schemas';

const kWorking_ms = 700;
const kIdle_ms = 15_000;
const kRuns = 100;
const kSent_ms = 4_000;

export const atWork = ({ state }: Pick<LabRun, 'state'>) => state === 'queued' || state === 'running';

export const modelsQuery = queryOptions({
  queryKey: ['lab', 'models'],
  queryFn: ({ signal }) => requestJson(address('/api/v1/lab/models', {}), modelListSchema, { signal }),
});

/** A version never changes: its file once fetched is kept. */
export const modelFileQuery = (id: string) =>
  queryOptions({
    queryKey: ['lab', 'model', id],
    queryFn: ({ signal }) =>
      requestJson(address('/api/v1/lab/models/{id}', { id }), v.record(v.string(), v.unknown()), { signal }),
    staleTime: Infinity,
  });

export const measurementsQuery = queryOptions({
  queryKey: ['lab', 'measurements'],
  queryFn: ({ signal }) => requestJson(address('/api/v1/lab/measurements', {}), measurementListSchema, { signal }),
});

export const effectsQuery = (rig: Rig) =>
  queryOptions({
    queryKey: ['lab', 'effects', rig],
    queryFn: ({ signal }) => requestJson(address('/api/v1/lab/effects', {}, { rig }), effectListSchema, { signal }),
    staleTime: Infinity,
  });

export interface RunsOf {
  readonly kind?: LabRun['kind'];
  readonly model?: string;
  readonly measurements?: string;
}

/** Newest first; refetched soon while one of them runs. */
export const labRunsQuery = (of: RunsOf = {}) =>
  queryOptions({
    queryKey: ['lab', 'runs', of],
    queryFn: ({ signal }) =>
      requestJson(address('/api/v1/lab/runs', {}, { ...of, limit: kRuns }), labRunListSchema, { signal }),
    refetchInterval: (query) => (query.state.data?.runs.some(atWork) ? kWorking_ms : kIdle_ms),
    refetchIntervalInBackground: true,
  });

export const labRunQuery = (id: string) =>
  queryOptions({
    queryKey: ['lab', 'run', id],
    queryFn: ({ signal }) => requestJson(address('/api/v1/lab/runs/{id}', { id }), labRunSchema, { signal }),
    refetchInterval: (query) => (query.state.data && atWork(query.state.data) ? kWorking_ms : false),
    refetchIntervalInBackground: true, // who looks at another window meanwhile finds it done
  });

export interface LabWindow {
  readonly trial: string;
  readonly channel: string;
  readonly side: 'before' | 'after';
  readonly from_s: number;
  readonly to_s: number;
  readonly points: number;
}

/** Of a finished run; never changes. */
export const labSignalsQuery = (id: string, window: LabWindow) =>
  queryOptions({
    queryKey: ['lab', 'signals', id, window],
    queryFn: ({ signal }) =>
      requestJson(address('/api/v1/lab/runs/{id}/signals', { id }, { ...window }), labSignalsSchema, { signal }),
    staleTime: Infinity,
  });

export const addModel = (file: string, parent?: string) =>
  requestJson(address('/api/v1/lab/models', {}, parent === undefined ? {} : { parent }), modelVersionSchema, {
    method: 'POST',
    text: file,
  });

const kUpload_ms = 10 * 60_000;

/** A zip of a folder with set.json. */
export const addMeasurements = (name: string, zip: Uint8Array<ArrayBuffer>) =>
  requestJson(address('/api/v1/lab/measurements', {}, { name }), measurementSetSchema, {
    method: 'POST',
    bytes: zip,
    timeout_ms: kUpload_ms,
  });

/** An effect of one's own, as tractus-effect/1. */
export type OwnEffect = Readonly<Record<string, unknown>>;

export const checkEffect = (own: OwnEffect, signal?: AbortSignal) =>
  requestJson(address('/api/v1/lab/effects/check', {}), effectCheckSchema, { method: 'POST', body: own, signal });

const started = (path: string, body?: unknown) => requestJson(path, labRunSchema, { method: 'POST', body });

export const startComparison = (model: string, measurements: string, against: string | null = null) =>
  started(address('/api/v1/lab/comparisons', {}), { model, measurements, against });
export const startDiagnosis = (model: string, measurements: string, own: readonly OwnEffect[] = []) =>
  started(address('/api/v1/lab/diagnoses', {}), { model, measurements, ...(own.length > 0 ? { own } : {}) });
export const startFit = (model: string, measurements: string, add: readonly string[], own: readonly OwnEffect[] = []) =>
  started(address('/api/v1/lab/fits', {}), {
    model,
    measurements,
    ...(add.length > 0 ? { add } : {}),
    ...(own.length > 0 ? { own } : {}),
  });
export const stopLabRun = (id: string) => started(address('/api/v1/lab/runs/{id}/stop', { id }));
export const publishRun = (id: string, name: string, note: string) =>
  requestJson(address('/api/v1/lab/runs/{id}/publish', { id }), modelVersionSchema, {
    method: 'POST',
    body: { name, note },
  });

/** Stations that a version was sent to; refetched while a station has not downloaded it. */
export const sentModelQuery = (id: string) =>
  queryOptions({
    queryKey: ['lab', 'sent', id],
    queryFn: ({ signal }) =>
      requestJson(address('/api/v1/lab/models/{id}/stations', { id }), sentModelSchema, { signal }),
    refetchInterval: (query) =>
      query.state.data?.stations.some(({ state }) => state === 'waiting') ? kSent_ms : false,
  });
/** To these stations; to every one without any. */
export const sendModel = (id: string, stations: readonly string[] | null) =>
  requestJson(address('/api/v1/lab/models/{id}/send', { id }), sentModelSchema, {
    method: 'POST',
    body: stations === null ? { all: true } : { stations },
  });

/** Takes a version back from a station, which forgets it at its next request. */
export const recallModel = (id: string, station_id: string) =>
  requestJson(address('/api/v1/lab/models/{id}/stations/{station_id}', { id, station_id }), sentModelSchema, {
    method: 'DELETE',
  });

const link = (path: string) => `/api/v1${path}`;
export const reportAddress = (id: string) => link(address('/api/v1/lab/runs/{id}/report', { id }));
export const betterModelAddress = (id: string) => link(address('/api/v1/lab/runs/{id}/model', { id }));
export const modelAddress = (id: string) => link(address('/api/v1/lab/models/{id}', { id }));
