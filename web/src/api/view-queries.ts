/** Views of lists that the signed-in person saved. */
import { queryOptions, useMutation, useQuery, useQueryClient } from '@tanstack/react-query';
import * as v from 'valibot';
import { address } from './address';
import { requestJson } from './client';
import { inUtc } from './quantities';

const kPages = ['trials', 'assignments', 'accounts', 'audit', 'cases'] as const;
type ListedPage = (typeof kPages)[number];

export const savedViewsSchema = v.object({
  views: v.array(
    v.object({
      id: v.string(),
      page: v.picklist(kPages),
      name: v.string(),
      search: v.string(),
      made_utc_us: inUtc,
    }),
  ),
});

const savedViewsQuery = queryOptions({
  queryKey: ['saved-views'],
  queryFn: ({ signal }) => requestJson(address('/api/v1/session/views', {}), savedViewsSchema, { signal }),
});

/** The views of one page, and how they change. */
export function useSavedViews(page: ListedPage) {
  const client = useQueryClient();
  const all = useQuery(savedViewsQuery).data?.views ?? [];
  const onSuccess = async (now: v.InferOutput<typeof savedViewsSchema>) => {
    await client.cancelQueries({ queryKey: savedViewsQuery.queryKey }); // a list asked for before the change would replace it
    client.setQueryData(savedViewsQuery.queryKey, now);
  };
  const save = useMutation({
    mutationFn: (view: { readonly name: string; readonly search: string }) =>
      requestJson(address('/api/v1/session/views', {}), savedViewsSchema, {
        method: 'POST',
        body: { page, ...view },
      }),
    onSuccess,
  });
  const remove = useMutation({
    mutationFn: (id: string) =>
      requestJson(`/session/views/${encodeURIComponent(id)}`, savedViewsSchema, { method: 'DELETE' }),
    onSuccess,
  });
  return {
    views: all.filter((view) => view.page === page),
    save: (name: string, search: string) => save.mutateAsync({ name, search }),
    remove: (id: string) => remove.mutateAsync(id),
  };
}
