/** How far each trainee is. */
import { queryOptions } from '@tanstack/react-query';
import * as v from 'valibot';
import { share } from '@/units';
import { address } from './address';
import { requestJson } from './client';
import { count, finite, inUtc } from './quantities';

const portion = v.pipe(finite, v.transform(share));

const ruleSchema = v.object({
  adequate: portion,
  inadequate: portion,
  trials: count,
  threshold: finite,
  relapse: finite,
  version: count,
  requirements: v.array(v.string()),
});

const standingFields = {
  trainee: v.string(),
  trials: count,
  right: count,
  share: portion,
  wilson_low: portion,
  wilson_high: portion,
  state: v.picklist(['learning', 'competent', 'relapsed']),
  certified: v.boolean(),
  why: v.string(),
  next: v.object({ scenario: v.string(), why: v.string() }),
  simulated: v.boolean(),
  last_utc_us: inUtc,
};

export const traineeListSchema = v.object({ rule: ruleSchema, trainees: v.array(v.object(standingFields)) });

export const traineeSchema = v.object({
  ...standingFields,
  rule: ruleSchema,
  competent_at_trial: v.nullable(count),
  relapses: v.array(v.object({ at_trial: count, recovered_at_trial: v.nullable(count) })),
  scenarios: v.array(
    v.object({
      scenario: v.string(),
      trials: count,
      right: count,
      verdict: v.string(),
      share: v.optional(portion),
      wilson_low: v.optional(portion),
      wilson_high: v.optional(portion),
    }),
  ),
  scores: v.array(
    v.object({
      score: v.string(),
      trials: count,
      first: v.optional(finite),
      rate: v.optional(finite),
      rate_p: v.nullish(finite),
      share_left_when_trials_double: v.optional(finite),
      note: v.optional(v.string()),
    }),
  ),
  attempts: v.array(
    v.object({
      number: count,
      /** Null, with the time, while the trial is rated blind. */
      trial: v.nullable(v.string()),
      scenario: v.string(),
      started_utc_us: v.nullable(inUtc),
      correct: v.boolean(),
      confidence: v.nullable(portion),
      sum: finite,
      relapse_sum: v.nullable(finite),
      scores: v.record(v.string(), v.nullable(finite)),
    }),
  ),
  calibration: v.array(
    v.object({
      low: portion,
      high: portion,
      stated: portion,
      trials: count,
      right: count,
      wilson_low: portion,
      wilson_high: portion,
    }),
  ),
});

export const traineesQuery = queryOptions({
  queryKey: ['trainees'],
  queryFn: ({ signal }) => requestJson(address('/api/v1/cohort/trainees', {}), traineeListSchema, { signal }),
});

export const traineeQuery = (name: string) =>
  queryOptions({
    queryKey: ['trainees', name],
    queryFn: ({ signal }) =>
      requestJson(address('/api/v1/cohort/trainees/{name}', { name }), traineeSchema, { signal }),
  });

/** Recognition of whole cohorts by running trial number, and each trainee beside the others. */
export const cohortProgressSchema = v.object({
  cohorts: v.array(
    v.object({
      id: v.string(),
      name: v.string(),
      bins: v.array(
        v.object({
          from: count,
          to: count,
          trainees: count,
          share: portion,
          low: v.nullable(portion),
          high: v.nullable(portion),
        }),
      ),
      trainees: v.array(
        v.object({
          trainee: v.string(),
          trials: count,
          recent_trials: count,
          recent_right: count,
          others_share: v.nullable(portion),
          behind: v.boolean(),
          last_utc_us: v.nullable(inUtc),
        }),
      ),
    }),
  ),
});

export const cohortProgressQuery = queryOptions({
  queryKey: ['cohort', 'progress'],
  queryFn: ({ signal }) => requestJson(address('/api/v1/cohort/progress', {}), cohortProgressSchema, { signal }),
});

export const metricsSchema = v.object({
  metrics: v.array(
    v.object({
      id: v.string(),
      label: v.string(),
      unit: v.string(),
      definition: v.string(),
      source: v.string(),
      /** null: trials of both rigs have it. */
      rig: v.nullable(v.picklist(['palpation', 'probing'])),
    }),
  ),
});

export const metricsQuery = queryOptions({
  queryKey: ['metrics'],
  queryFn: ({ signal }) => requestJson(address('/api/v1/metrics', {}), metricsSchema, { signal }),
  staleTime: Infinity,
});

export type TraineeSummary = v.InferOutput<typeof traineeListSchema>['trainees'][number];
export type Trainee = v.InferOutput<typeof traineeSchema>;
export type Attempt = Trainee['attempts'][number];
export type CalibrationBin = Trainee['calibration'][number];
export type MetricFacts = v.InferOutput<typeof metricsSchema>['metrics'][number];
export type CohortProgress = v.InferOutput<typeof cohortProgressSchema>['cohorts'][number];
export type TraineePace = CohortProgress['trainees'][number];
