/** The hospital's PACS: its studies and series, and imports from it. What names a patient goes in bodies, never in an address. */
import { queryOptions } from '@tanstack/react-query';
import * as v from 'valibot';
import { address } from './address';
import { requestJson } from './client';
import type { components } from './generated/schema';
import { count, inMetres } from './quantities';

const kMoving_ms = 1_000;

export const pacsSchema = v.object({ address: v.nullable(v.string()) });
export const pacsStudiesSchema = v.object({
  studies: v.array(
    v.object({
      uid: v.string(),
      date: v.nullable(v.string()),
      description: v.string(),
      modalities: v.array(v.string()),
      series: v.nullable(count),
      files: v.nullable(count),
    }),
  ),
  more: v.boolean(),
});
export const pacsSeriesListSchema = v.object({
  series: v.array(
    v.object({
      uid: v.string(),
      number: v.nullable(count),
      modality: v.string(),
      description: v.string(),
      files: v.nullable(count),
      row_spacing_m: v.nullable(inMetres),
      column_spacing_m: v.nullable(inMetres),
      thickness_m: v.nullable(inMetres),
      slice_spacing_m: v.nullable(inMetres),
    }),
  ),
});
export const pacsImportSchema = v.object({
  id: v.string(),
  state: v.picklist(['fetching', 'reading', 'done', 'failed']),
  files: count,
  size_bytes: count,
  error: v.string(),
  volume: v.nullable(v.string()),
});

export type PacsSearch = components['schemas']['PacsSearch'];
export type PacsStudy = v.InferOutput<typeof pacsStudiesSchema>['studies'][number];
export type PacsSeries = v.InferOutput<typeof pacsSeriesListSchema>['series'][number];
export type PacsImport = v.InferOutput<typeof pacsImportSchema>;

const posted = { method: 'POST' } as const;

export const pacsQuery = queryOptions({
  queryKey: ['pacs'],
  queryFn: ({ signal }) => requestJson('/pacs', pacsSchema, { signal }),
  staleTime: Infinity,
});
export const findPacsStudies = (search: PacsSearch) =>
  requestJson('/pacs/studies', pacsStudiesSchema, { ...posted, body: search });
export const pacsSeriesQuery = (study: string) =>
  queryOptions({
    queryKey: ['pacs', 'series', study],
    queryFn: ({ signal }) =>
      requestJson('/pacs/series', pacsSeriesListSchema, { ...posted, body: { study_uid: study }, signal }),
    retry: false,
  });
export const importPacsSeries = (wish: components['schemas']['PacsImportWish']) =>
  requestJson('/pacs/imports', pacsImportSchema, { ...posted, body: wish });

/** The imports that were begun on this visit, the newest first: whoever leaves the page and comes back sees what became of them. */
export const pacsBegunQuery = queryOptions({
  queryKey: ['pacs', 'begun'],
  queryFn: (): readonly { readonly id: string; readonly name: string }[] => [],
  staleTime: Infinity,
  gcTime: Infinity,
});

const isMoving = ({ state }: PacsImport) => state === 'fetching' || state === 'reading';
export const pacsImportQuery = (id: string) =>
  queryOptions({
    queryKey: ['pacs', 'import', id],
    queryFn: ({ signal }) => requestJson(address('/api/v1/pacs/imports/{id}', { id }), pacsImportSchema, { signal }),
    refetchInterval: (query) => (query.state.data === undefined || isMoving(query.state.data) ? kMoving_ms : false),
    refetchIntervalInBackground: true, // who looks at another window meanwhile finds it done
  });
