/** What the server may say, checked once as it comes in. Everything behind this file is typed and trusted. */
import * as v from 'valibot';
import { kNone, share } from '@/units';
import { pageFields } from './lists';
import { count, finite, inMetres, inNewtons, inSeconds, inUtc } from './quantities';

/** Three numbers of the patient's frame. */
const point = v.tuple([finite, finite, finite]);
const wall = v.picklist(['medial', 'lateral', 'superior', 'inferior', 'anterior']);

/** `must_change`: the password was made by another, and nothing else is answered until it is changed. */
export const sessionSchema = v.object({
  name: v.string(),
  role: v.string(),
  id: v.optional(v.string(), ''),
  must_change: v.optional(v.boolean(), false),
  /** That the person chose; null: none. */
  language: v.optional(v.nullable(v.string()), null),
});

export const trialStateSchema = v.picklist(['assessing', 'assessed', 'failed']);

export const trialSummarySchema = v.object({
  id: v.string(),
  case_id: v.string(),
  case_title: v.string(),
  station: v.string(),
  operator_name: v.string(),
  /** Name of the account to which the trial was assigned; empty without an assignment. */
  person: v.string(),
  simulated: v.boolean(),
  started_utc_us: inUtc,
  duration_s: inSeconds,
  samples: count,
  state: trialStateSchema,
  correct: v.nullable(v.boolean()),
});

export const trialPageSchema = v.object({
  trials: v.array(trialSummarySchema),
  ...pageFields,
});

export const metricSchema = v.object({
  id: v.string(),
  label: v.string(),
  unit: v.string(),
  value: v.nullable(finite),
  note: v.string(),
  definition: v.string(),
  source: v.string(),
  shown_as: v.picklist(['number', 'share', 'correct_or_incorrect']),
  cell: v.nullable(v.object({ row: v.string(), symbol: v.string(), column: v.string() })),
});

export const coverageSchema = v.pipe(
  v.object({ depth_bins: count, angle_bins: count, samples: v.array(count) }),
  v.check((c) => c.samples.length === c.depth_bins * c.angle_bins, 'coverage: samples must be depth_bins × angle_bins'),
);

export const tractSchema = v.object({
  entry_m: point,
  axis: point,
  length_m: inMetres,
  radius_m: inMetres,
  medial: point,
  superior: point,
});

/** An event's detail is the station's own: kept as it is, and shown only for the kinds known here. */
export const eventSchema = v.object({ t_s: inSeconds, kind: v.string(), detail: v.unknown() });

export const answerSchema = v.object({
  breach: v.boolean(),
  wall: v.nullish(wall, null),
  confidence: v.nullish(v.pipe(finite, v.transform(share)), null),
  /** Probing: where it was felt. */
  depth_m: v.nullish(inMetres, null),
});

/** The bone of a probing trial: what was to be felt. */
export const scenarioSchema = v.object({
  id: v.string(),
  name: v.string(),
  travel_m: inMetres,
  layers: v.array(
    v.object({ start_m: inMetres, thickness_m: inMetres, stiffness_N_per_m: finite, damping_Ns_per_m: finite }),
  ),
  walls: v.array(v.object({ position_m: inMetres, resistance_interval_m: inMetres, breach_interval_m: inMetres })),
});

/** Where a trial stands in a study. */
export const placeSchema = v.object({
  id: v.string(),
  title: v.string(),
  participant: v.string(),
  number: count,
  state: v.picklist(['arriving', 'counts', 'invalid', 'surplus']),
  reason: v.string(),
});

export const truthSchema = v.object({ breached: v.nullish(wall, null) });

export const trialSchema = v.object({
  id: v.string(),
  case_id: v.string(),
  case_title: v.string(),
  station: v.string(),
  operator_name: v.string(),
  /** Name of the account to which the trial was assigned; empty without an assignment. */
  person: v.string(),
  simulated: v.boolean(),
  rig: v.picklist(['palpation', 'probing']),
  device: v.string(),
  started_utc_us: inUtc,
  duration_s: inSeconds,
  samples: count,
  rate_Hz: finite,
  complete: v.boolean(),
  /** Why the assessment failed, where it did. */
  failure: v.nullish(v.string(), null),
  state: trialStateSchema,
  late_ticks: count,
  not_converged: count,
  skipped_ticks: count,
  events: v.array(eventSchema),
  answer: v.nullish(answerSchema, null),
  truth: v.nullish(truthSchema, null),
  metrics: v.array(metricSchema),
  tract: v.nullable(tractSchema),
  scenario: v.nullish(scenarioSchema, null),
  study: v.nullish(placeSchema, null),
  coverage: v.nullish(coverageSchema, null),
});

const envelope = v.pipe(
  v.object({ min: v.array(v.nullable(finite)), max: v.array(v.nullable(finite)) }),
  v.check((c) => c.min.length === c.max.length, 'channel: min and max must be as long as one another'),
);

export const signalsSchema = v.pipe(
  v.object({
    t_s: v.array(finite),
    channels: v.record(v.string(), envelope),
    from_s: inSeconds,
    to_s: inSeconds,
    samples_per_point: finite,
  }),
  v.check(
    (s) => Object.values(s.channels).every((c) => c.min.length === s.t_s.length),
    'signals: every channel must be as long as t_s',
  ),
);

export const pathSchema = v.pipe(
  v.object({ t_s: v.array(finite), tip_m: v.array(point), force_N: v.array(inNewtons) }),
  v.check(
    (p) => p.tip_m.length === p.t_s.length && p.force_N.length === p.t_s.length,
    'path: columns must be as long as one another',
  ),
);

export const kModes = ['holding', 'bone', 'resistance', 'breach', 'stopped'] as const;

export const forceDepthSchema = v.pipe(
  v.object({
    t_s: v.array(finite),
    depth_m: v.array(finite),
    force_N: v.array(finite),
    mode: v.array(v.picklist(kModes)),
  }),
  v.check(
    (c) => [c.depth_m, c.force_N, c.mode].every((column) => column.length === c.t_s.length),
    'force against depth: columns must be as long as one another',
  ),
);

export type Session = v.InferOutput<typeof sessionSchema>;
export type TrialState = v.InferOutput<typeof trialStateSchema>;
/** The person who did a trial, by the name of the account where it is known; a dash while the trial is rated blind. */
export const personOf = ({ person, operator_name }: Pick<TrialSummary, 'person' | 'operator_name'>): string =>
  person || operator_name || kNone;
export type TrialSummary = v.InferOutput<typeof trialSummarySchema>;
export type TrialPage = v.InferOutput<typeof trialPageSchema>;
export type Metric = v.InferOutput<typeof metricSchema>;
export type Coverage = v.InferOutput<typeof coverageSchema>;
export type Tract = v.InferOutput<typeof tractSchema>;
export type TrialEvent = v.InferOutput<typeof eventSchema>;
export type Answer = v.InferOutput<typeof answerSchema>;
export type Truth = v.InferOutput<typeof truthSchema>;
export type Wall = v.InferOutput<typeof wall>;
export type Trial = v.InferOutput<typeof trialSchema>;
export type Signals = v.InferOutput<typeof signalsSchema>;
export type Scenario = v.InferOutput<typeof scenarioSchema>;
export type StudyPlace = v.InferOutput<typeof placeSchema>;
export type ForceDepth = v.InferOutput<typeof forceDepthSchema>;
export type Path = v.InferOutput<typeof pathSchema>;
