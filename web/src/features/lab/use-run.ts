/** The run that a page shows: the newest of its kind that is asked for, and how another is begun. */
import { useMutation, useQuery, useQueryClient } from '@tanstack/react-query';
import { useEffect, useRef } from 'react';
import { labRunQuery, labRunsQuery, startComparison, type LabRun, type LabRunSummary } from '@/api';

export interface RunView {
  /** null: none was asked for yet; undefined: not known yet. */
  readonly run: LabRun | null | undefined;
  readonly error: Error | null;
  readonly begin: () => void;
  readonly beginning: boolean;
  readonly retry: () => void;
}

interface Asked { readonly kind: LabRun['kind']; readonly model: string; readonly set: string; readonly fits: (run: LabRunSummary) => boolean; readonly start: () => Promise<LabRun> }

export function useRun({ kind, model, set, fits, start }: Asked): RunView {
  const client = useQueryClient();
  const list = useQuery(labRunsQuery({ kind, model, measurements: set }));
  const newest = list.data?.runs.find(fits);
  const one = useQuery({ ...labRunQuery(newest?.id ?? ''), enabled: newest !== undefined });
  const begun = useMutation({
    mutationFn: start,
    onSuccess: async (run) => {
      client.setQueryData(labRunQuery(run.id).queryKey, run);
      await client.invalidateQueries({ queryKey: ['lab', 'runs'] });
    },
  });
  return {
    run: newest ? one.data : list.data ? null : undefined,
    error: begun.error ?? list.error ?? one.error,
    begin: () => begun.mutate(),
    beginning: begun.isPending,
    retry: () => { begun.reset(); void list.refetch(); if (newest) void one.refetch(); },
  };
}

/** Two versions (or one alone) beside a set: begun by itself where it was not made yet, for it is short. */
export function useComparison(model: string, set: string, against: string | null): RunView {
  const view = useRun({
    kind: 'comparison', model, set, fits: (run) => run.against === against, start: () => startComparison(model, set, against),
  });
  const asked = useRef('');
  const key = `${model} ${set} ${against ?? ''}`;
  const { run, begin } = view;
  useEffect(() => {
    if (run !== null || asked.current === key) return;
    asked.current = key;
    begin();
  }, [run, key, begin]);
  return view;
}
