/** The cohort: its table, locked plans, and analyses of it. */
import { queryOptions } from '@tanstack/react-query';
import * as v from 'valibot';
import { share } from '@/units';
import { address } from './address';
import { requestJson, bytes } from './client';
import { count, finite, inUtc } from './quantities';

const kWorking_ms = 700;

const row = v.record(v.string(), v.unknown());

export const planSummarySchema = v.object({
  id: v.string(),
  title: v.string(),
  study: v.nullable(v.string()),
  data_seen: v.boolean(),
  trials_then: count,
  made_utc_us: inUtc,
  made_by: v.string(),
});
export const planListSchema = v.object({ plans: v.array(planSummarySchema) });

const runFields = {
  id: v.string(),
  plan: v.nullable(v.string()),
  study: v.nullable(v.string()),
  state: v.picklist(['queued', 'running', 'done', 'failed', 'cancelled']),
  share: v.pipe(finite, v.transform(share)),
  error: v.string(),
  snapshot: v.nullable(v.string()),
  made_utc_us: inUtc,
  made_by: v.string(),
};
export const analysisRunSchema = v.object(runFields);
/** Of tractus-plan/1 what a page shows. */
const planFileSchema = v.object({
  analyses: v.array(
    v.object({
      id: v.string(),
      question: v.optional(v.string()),
      family: v.optional(v.string()),
      method: v.string(),
      formula: v.optional(v.string()),
    }),
  ),
});
export const lockedPlanSchema = v.object({
  ...planSummarySchema.entries,
  plan: planFileSchema,
  analyses: v.array(analysisRunSchema),
});

/** One test, as a plan corrects it. */
const testSchema = v.looseObject({
  analysis: v.optional(v.string()),
  term: v.string(),
  statistic: v.optional(v.string(), ''),
  value: v.optional(v.nullable(finite), null),
  p: v.nullable(finite),
  note: v.optional(v.string()),
  p_adjusted: v.optional(v.nullable(finite)),
  holds: v.optional(v.boolean()),
  effect: v.optional(v.string()),
  size: v.optional(v.nullable(finite)),
  ci95_low: v.optional(v.nullable(finite)),
  ci95_high: v.optional(v.nullable(finite)),
  df1: v.optional(v.nullable(finite)),
  df2: v.optional(v.nullable(finite)),
});

const numbers = v.array(v.nullable(finite));
/** A figure as data: panels of points, curves and bands. */
const figureSchema = v.object({
  note: v.string(),
  panels: v.array(
    v.object({
      title: v.string(),
      x_label: v.string(),
      y_label: v.string(),
      /** Of x = 1, 2, …; none: x is a number. */
      group_names: v.array(v.string()),
      lines: v.array(v.object({ label: v.string(), x: numbers, y: numbers, points: v.boolean() })),
      ribbons: v.array(v.object({ label: v.string(), x: numbers, low: numbers, high: numbers })),
      marks: v.array(v.object({ at: finite, label: v.string() })),
    }),
  ),
});

export const analysisResultSchema = v.object({
  plan: v.looseObject({ title: v.string(), question: v.string(), endpoint: v.string() }),
  data: v.looseObject({
    name: v.string(),
    sha256: v.string(),
    rows: count,
    rows_used: count,
    simulated: v.optional(v.boolean(), false),
    exclusions: v.array(v.object({ where: v.string(), reason: v.string(), rows: count })),
  }),
  analyses: v.array(
    v.looseObject({
      id: v.string(),
      question: v.string(),
      method: v.string(),
      formula: v.optional(v.string(), ''),
      where: v.optional(v.string(), ''),
      report: v.nullish(row, null),
      figures: v.optional(v.array(figureSchema), []),
      error: v.nullish(v.string(), null),
    }),
  ),
  families: v.array(v.object({ name: v.string(), correction: v.string(), alpha: finite, tests: v.array(testSchema) })),
  published: v.array(
    v.looseObject({
      where: v.string(),
      says: v.string(),
      printed: v.optional(v.nullable(finite)),
      computed: v.optional(v.nullable(finite)),
      agrees: v.optional(v.nullable(v.boolean())),
      remark: v.optional(v.string(), ''),
    }),
  ),
  methods: v.array(v.string()),
  results: v.array(v.string()),
});

export const readAnalysisResult = (json: unknown) => v.parse(analysisResultSchema, json);

export const analysisSchema = v.object({
  ...runFields,
  result: v.nullable(analysisResultSchema),
  repeats: v.nullable(v.string()),
  same_digits: v.nullable(v.boolean()),
});

const tablePath = (study: string) => address('/api/v1/cohort/table', {}, study === '' ? {} : { study });
export const cohortTableAddress = (study: string) => `/api/v1${tablePath(study)}`;
export const cohortTableQuery = (study: string) =>
  queryOptions({
    queryKey: ['cohort', 'table', study],
    queryFn: async ({ signal }) => {
      const [{ tableOf }, { data }] = await Promise.all([
        import('./cohort-table'),
        bytes(tablePath(study), { signal }),
      ]);
      return tableOf(new TextDecoder().decode(data));
    },
  });

export const plansQuery = queryOptions({
  queryKey: ['cohort', 'plans'],
  queryFn: ({ signal }) => requestJson(address('/api/v1/cohort/plans', {}), planListSchema, { signal }),
});
export const planQuery = (id: string) =>
  queryOptions({
    queryKey: ['cohort', 'plans', id],
    queryFn: ({ signal }) => requestJson(address('/api/v1/cohort/plans/{id}', { id }), lockedPlanSchema, { signal }),
  });
export const analysisQuery = (id: string) =>
  queryOptions({
    queryKey: ['cohort', 'analysis', id],
    queryFn: ({ signal }) => requestJson(address('/api/v1/cohort/analyses/{id}', { id }), analysisSchema, { signal }),
    refetchInterval: (query) =>
      query.state.data && ['queued', 'running'].includes(query.state.data.state) ? kWorking_ms : false,
  });

export const lockPlan = (plan: Readonly<Record<string, unknown>>, study: string, dataSeen: boolean) =>
  requestJson(address('/api/v1/cohort/plans', {}), planSummarySchema, {
    method: 'POST',
    body: { plan, ...(study === '' ? {} : { study }), data_seen: dataSeen },
  });
export const runPlan = (plan: string, snapshot?: string) =>
  requestJson(address('/api/v1/cohort/analyses', {}), analysisRunSchema, {
    method: 'POST',
    body: { plan, ...(snapshot === undefined ? {} : { snapshot }) },
  });
export const stopAnalysis = (id: string) =>
  requestJson(address('/api/v1/cohort/analyses/{id}/stop', { id }), analysisRunSchema, { method: 'POST' });
export const runMethod = (
  method: string,
  formula: string,
  study: string,
  options: Readonly<Record<string, string>> = {},
) =>
  requestJson(address('/api/v1/cohort/analyses', {}), analysisRunSchema, {
    method: 'POST',
    body: {
      method,
      formula,
      ...(study === '' ? {} : { study }),
      ...(Object.keys(options).length === 0 ? {} : { options }),
    },
  });
export const analysisFile = (id: string, part: 'report.html' | 'result.json' | 'data.csv' | 'dictionary.json') =>
  `/api/v1${address('/api/v1/cohort/analyses/{id}/{part}', { id, part })}`;

export type PlanSummary = v.InferOutput<typeof planSummarySchema>;
export type LockedPlan = v.InferOutput<typeof lockedPlanSchema>;
export type AnalysisRun = v.InferOutput<typeof analysisRunSchema>;
export type AnalysisResult = v.InferOutput<typeof analysisResultSchema>;
export type PlannedTest = v.InferOutput<typeof testSchema>;
export type AnalysisFigure = v.InferOutput<typeof figureSchema>;
