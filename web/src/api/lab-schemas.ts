/** What the server says of the model lab: versions of models, measurement sets, effects, and what was asked of them. */
import * as v from 'valibot';
import { share } from '@/units';
import { count, finite, inSeconds, inUtc } from './quantities';

const rig = v.picklist(['probing', 'palpation']);
/** A figure that may not exist. */
const figure = v.nullable(finite);
const portion = v.pipe(finite, v.transform(share));

export const modelVersionSchema = v.object({
  id: v.string(),
  name: v.string(),
  rig,
  note: v.string(),
  parent: v.nullable(v.string()),
  run: v.nullable(v.string()),
  made_utc_us: inUtc,
  made_by: v.string(),
});
export const modelListSchema = v.object({ models: v.array(modelVersionSchema) });

export const measurementSetSchema = v.object({
  id: v.string(),
  name: v.string(),
  rig: v.nullable(rig),
  simulated: v.nullable(v.boolean()),
  trials: v.nullable(count),
  samples: v.nullable(count),
  size_bytes: count,
  made_utc_us: inUtc,
  made_by: v.string(),
});
export const measurementListSchema = v.object({ measurements: v.array(measurementSetSchema) });

export const effectSchema = v.object({
  id: v.string(),
  rig: v.string(),
  kind: v.picklist(['force', 'structure', 'measurement']),
  summary: v.string(),
  equation: v.string(),
  source: v.string(),
  parameters: v.array(
    v.object({
      name: v.string(),
      unit: v.string(),
      meaning: v.string(),
      components: count,
      initial: finite,
      low: finite,
      high: finite,
    }),
  ),
});
export const effectListSchema = v.object({
  effects: v.array(effectSchema),
  states: v.array(v.object({ name: v.string(), unit: v.string(), meaning: v.string() })),
  adds_to: v.string(),
  adds_unit: v.string(),
});
export const effectCheckSchema = v.object({ ok: v.boolean(), error: v.string(), effect: v.nullable(effectSchema) });

const distribution = v.object({
  mean: figure,
  sd: figure,
  p05: figure,
  p50: figure,
  p95: figure,
  edges: v.array(figure),
  shares: v.array(figure),
});
const spectrum = v.object({
  frequency_Hz: v.array(figure),
  measured: v.array(figure),
  simulated: v.array(figure),
  residual: v.array(figure),
});

export const channelSchema = v.object({
  name: v.string(),
  rmse: figure,
  r2: figure,
  noise_floor: figure,
  explained: figure,
  bias: v.optional(figure),
  measured: v.optional(distribution),
  simulated: v.optional(distribution),
  residual: v.optional(distribution),
  spectrum: v.optional(spectrum),
});

export const regionSchema = v.object({
  region: v.string(),
  words: v.string(),
  share_of_error: portion,
  share_of_time: portion,
  rmse: figure,
  mean: v.array(figure),
});

export const comparisonSchema = v.object({
  primary: v.string(),
  channels: v.array(channelSchema),
  trials: v.array(
    v.object({ id: v.string(), rmse: figure, channels: v.record(v.string(), figure), duration_s: inSeconds }),
  ),
  where: v.array(regionSchema),
  where_method: v.string(),
  phases: v.array(
    v.object({
      phase: v.string(),
      rmse: figure,
      share_of_error: portion,
      share_of_time: portion,
      judged_share: v.optional(portion),
    }),
  ),
  judgements: v.optional(v.array(v.object({ judgement: v.string(), share: portion })), []),
});

const several = v.union([figure, v.array(figure)]);
const parameters = v.record(v.string(), v.object({ value: several, sd: several }));
const estimate = v.object({
  name: v.string(),
  value: figure,
  sd: figure,
  informed: v.boolean(),
  at_bound: v.boolean(),
});
const fittedTrial = v.object({ id: v.string(), rmse: figure, held_out_rmse: figure });
export const rankedSchema = v.object({
  id: v.string(),
  probability: figure,
  held_out_rmse: figure,
  note: v.optional(v.string(), ''),
  detection_limits: v.optional(v.array(v.object({ parameter: v.string(), value: figure, text: v.string() })), []),
});

/** tractus-program/1, kept whole: it is downloaded for a station. */
const motionProgramSchema = v.object({
  format: v.literal('tractus-program/1'),
  rig: v.literal('probing'),
  name: v.string(),
  words: v.string(),
  start_m: finite,
  start_rad: finite,
  acceleration_m_s2: finite,
  acceleration_rad_s2: finite,
  moves: v.array(v.object({ to_m: finite, speed_m_s: finite, to_rad: finite, speed_rad_s: finite, hold_s: finite })),
});

export const diagnosisSchema = v.object({
  verdict: v.picklist(['complete', 'missing', 'partly', 'unexplained', 'undecided']),
  headline: v.optional(v.string(), ''),
  detail: v.optional(v.string(), ''),
  probability: figure,
  base: v.object({ rmse: figure, held_out_rmse: figure, noise_floor: figure }),
  effects: v.array(v.object({ id: v.string(), probability: figure, parameters })),
  ranking: v.array(rankedSchema),
  steps: v.array(v.object({ model: v.string(), rmse: figure, held_out_rmse: figure })),
  confounded: v.array(v.tuple([v.string(), v.string()])),
  settle: v.nullable(
    v.object({
      between: v.array(v.string()),
      recording: v.string(),
      expected_gain: figure,
      programs: v.optional(
        v.array(
          v.object({
            name: v.string(),
            recording: v.string(),
            duration_s: inSeconds,
            expected_gain: figure,
            program: motionProgramSchema,
          }),
        ),
        [],
      ),
    }),
  ),
  depends_on: v.string(),
  held_out: v.string(),
  parameters: v.array(estimate),
  trials: v.array(fittedTrial),
  notes: v.array(v.string()),
});

export const fitSchema = v.object({
  base: v.object({ rmse: figure, noise_floor: figure }),
  rmse: figure,
  held_out_rmse: figure,
  noise_floor: figure,
  converged: v.boolean(),
  held_out: v.string(),
  effects: v.array(v.object({ id: v.string(), parameters })),
  parameters: v.array(estimate),
  correlations: v.array(v.object({ between: v.array(v.string()), correlation: figure })),
  trials: v.array(fittedTrial),
  remarks: v.array(v.string()),
});

const point = v.tuple([finite, finite, finite]);
export const tractMapSchema = v.object({
  depth_m: v.array(finite),
  angle_rad: v.array(finite),
  rmse: v.array(v.array(figure)),
  share: v.array(v.array(figure)),
  tract: v.nullish(v.object({ entry_m: point, axis: point, length_m: finite }), null),
});

const runFields = {
  id: v.string(),
  kind: v.picklist(['diagnosis', 'comparison', 'fit']),
  model: v.string(),
  against: v.nullable(v.string()),
  measurements: v.string(),
  add: v.array(v.string()),
  own: v.array(v.string()),
  state: v.picklist(['queued', 'running', 'done', 'failed', 'cancelled']),
  share: portion,
  phase: v.string(),
  error: v.string(),
  made_utc_us: inUtc,
  made_by: v.string(),
  model_ready: v.boolean(),
  version: v.nullable(v.string()),
};
export const labRunSchema = v.object({
  ...runFields,
  ranking: v.nullable(v.array(rankedSchema)),
  diagnosis: v.nullable(diagnosisSchema),
  fit: v.nullable(fitSchema),
  comparisons: v.nullable(v.object({ before: comparisonSchema, after: v.nullable(comparisonSchema) })),
  tract_map: v.nullable(tractMapSchema),
});
export const labRunListSchema = v.object({ runs: v.array(v.object(runFields)) });

const envelope = v.object({ min: v.array(figure), max: v.array(figure) });
export const labSignalsSchema = v.pipe(
  v.object({
    trial: v.string(),
    channel: v.string(),
    side: v.picklist(['before', 'after']),
    duration_s: finite,
    t_s: v.array(finite),
    measured: envelope,
    simulated: envelope,
    residual: envelope,
    noise_floor: figure,
    samples_per_point: finite,
    regions: v.array(v.array(v.tuple([finite, finite]))),
  }),
  v.check(
    (s) =>
      [s.measured, s.simulated, s.residual].every(
        (c) => c.min.length === s.t_s.length && c.max.length === s.t_s.length,
      ),
    'signals: every series must be as long as t_s',
  ),
);

/** Every station, and whether a version was sent there. */
export const sentModelSchema = v.object({
  stations: v.array(
    v.object({
      id: v.string(),
      name: v.string(),
      state: v.picklist(['not_sent', 'waiting', 'there']),
      asked_utc_us: v.nullable(inUtc),
      asked_by: v.string(),
      there_utc_us: v.nullable(inUtc),
    }),
  ),
});
export type SentModel = v.InferOutput<typeof sentModelSchema>;

export type ModelVersion = v.InferOutput<typeof modelVersionSchema>;
export type MeasurementSet = v.InferOutput<typeof measurementSetSchema>;
export type Rig = v.InferOutput<typeof rig>;
export type Effect = v.InferOutput<typeof effectSchema>;
export type EffectList = v.InferOutput<typeof effectListSchema>;
export type EffectCheck = v.InferOutput<typeof effectCheckSchema>;
export type LabChannel = v.InferOutput<typeof channelSchema>;
export type LabRegion = v.InferOutput<typeof regionSchema>;
export type Comparison = v.InferOutput<typeof comparisonSchema>;
export type Distribution = v.InferOutput<typeof distribution>;
export type Diagnosis = v.InferOutput<typeof diagnosisSchema>;
export type Ranked = v.InferOutput<typeof rankedSchema>;
export type Fit = v.InferOutput<typeof fitSchema>;
export type Estimate = v.InferOutput<typeof estimate>;
export type TractMap = v.InferOutput<typeof tractMapSchema>;
export type LabRun = v.InferOutput<typeof labRunSchema>;
export type LabRunSummary = v.InferOutput<typeof labRunListSchema>['runs'][number];
export type LabSignals = v.InferOutput<typeof labSignalsSchema>;
