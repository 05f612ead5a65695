/** The run that a page shows: the newest of its kind that is asked for, and how another is started. */
import { useMutation, useQuery, useQueryClient } from '@tanstack/react-query';
import { useEffect, useRef } from 'react';
import { labRunQuery, labRunsQuery, startComparison, type LabRun, type LabRunSummary } from '@/api';

export interface RunView {
  /** null: no run yet; undefined: loading. */
  readonly run: LabRun | null | undefined;
  readonly error: Error | null;
  readonly begin: () => void;
  readonly beginning: boolean;
  readonly retry: () => void;
}

interface RunRequest {
  readonly kind: LabRun['kind'];
  readonly model: string;
  readonly set: string;
  readonly fits: (run: LabRunSummary) => boolean;
  readonly start: () => Promise<LabRun>;
}

export function useRun({ kind, model, set, fits, start }: RunRequest): RunView {
  const client = useQueryClient();
  const list = useQuery(labRunsQuery({ kind, model, measurements: set }));
  const newest = list.data?.runs.find(fits);
  const one = useQuery({ ...labRunQuery(newest?.id ?? ''), enabled: newest !== undefined });
  const started = useMutation({
    mutationFn: start,
    onSuccess: async (run) => {
      client.setQueryData(labRunQuery(run.id).queryKey, run);
      await client.invalidateQueries({ queryKey: ['lab', 'runs'] });
    },
  });
  return {
    run: newest ? one.data : list.data ? null : undefined,
    error: started.error ?? list.error ?? one.error,
    begin: () => started.mutate(),
    beginning: started.isPending,
    retry: () => {
      started.reset();
      void list.refetch();
      if (newest) void one.refetch();
    },
  };
}

/** Compares one or two versions with a measurement set; starts the comparison if there is none. */
export function useComparison(model: string, set: string, against: string | null): RunView {
  const view = useRun({
    kind: 'comparison',
    model,
    set,
    fits: (run) => run.against === against,
    start: () => startComparison(model, set, against),
  });
  const startedKey = useRef('');
  const key = `${model} ${set} ${against ?? ''}`;
  const { run, begin } = view;
  useEffect(() => {
    if (run !== null || startedKey.current === key) return;
    startedKey.current = key;
    begin();
  }, [run, key, begin]);
  return view;
}
