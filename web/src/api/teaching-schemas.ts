/** What the server says of volumes, cases and their making, probing scenarios, assignments, comments and examples. */
import * as v from 'valibot';
import { pageFields } from './lists';
import { count, finite, inMetres, inNewtons, inSeconds, inUtc } from './quantities';
import { tractSchema } from './schemas';

const point = v.tuple([finite, finite, finite]);
export const kWalls = ['medial', 'lateral', 'superior', 'inferior', 'anterior'] as const;
const wall = v.picklist(kWalls);

export const sourceVolumeSchema = v.object({
  id: v.string(),
  name: v.string(),
  source: v.string(),
  state: v.picklist(['held', 'released', 'refused']),
  format: v.string(),
  modality: v.nullable(v.string()),
  dims: v.tuple([count, count, count]),
  spacing_m: point,
  origin_m: point,
  directions: v.array(finite),
  range: v.tuple([finite, finite]),
  notes: v.array(v.string()),
  suspicions: v.array(v.string()),
  size_bytes: count,
  made_utc_us: inUtc,
  made_by: v.string(),
  released_by: v.nullable(v.string()),
  decided_utc_us: v.nullable(inUtc),
  reason: v.string(),
});
export const sourceVolumeListSchema = v.object({ volumes: v.array(sourceVolumeSchema) });

export const caseSummarySchema = v.object({
  id: v.string(),
  title: v.string(),
  source: v.string(),
  made_utc_us: inUtc,
  trials: count,
  retired: v.boolean(),
  planned: v.boolean(),
  felt: v.picklist(['untried', 'told', 'not_told', 'not_known']),
});
export const caseListSchema = v.object({ cases: v.array(caseSummarySchema), ...pageFields });
/** Of the signed manifest and of the truth what a page shows. */
export const caseManifestSchema = v.object({
  title: v.string(),
  source: v.string(),
  made_utc_us: inUtc,
  tract: tractSchema,
  channel: v.optional(v.literal('planned')),
  preparation: v.optional(v.picklist(['published', 'filled']), 'published'),
});
export const caseTruthSchema = v.object({
  breached: v.nullish(wall, null),
  breach_m: v.nullish(point, null),
  breach_depth_m: v.optional(inMetres, 0),
  wall_thickness_m: v.optional(inMetres, 0),
});

const dPrime = v.nullable(finite);
/** What an observer can tell of a wall; `places` is absent in certificates of before. */
export const wallCertificateSchema = v.object({
  wall,
  passes: v.boolean(),
  at_m: v.nullable(inMetres),
  k: dPrime,
  b: dPrime,
  fa: dPrime,
  /** Share of right answers that a hand is foretold; absent in certificates of before. */
  foretold: v.optional(finite),
  end_force_N: v.nullable(finite),
  why_not: v.nullable(v.string()),
  places: v.optional(v.object({ at_m: v.array(finite), k: v.array(dPrime), b: v.array(dPrime), fa: v.array(dPrime) })),
});
export const certificateSchema = v.object({ passes: v.boolean(), walls: v.array(wallCertificateSchema) });
export const plannedCertificateSchema = v.object({
  certificate: v.nullable(certificateSchema),
  warning: v.string(),
  problem: v.string(),
});

export const plannedWallSchema = v.object({
  wall,
  depth_m: v.array(finite),
  inner_m: v.array(v.nullable(finite)),
  thickness_m: v.array(v.nullable(finite)),
  thinnest: v.nullable(v.object({ at_m: inMetres, inner_m: inMetres, thickness_m: inMetres })),
});
/** The vertebra's outer face: a closed mesh, row by row from pole to pole, `around` points a row. */
export const envelopeSchema = v.object({ around: count, points_m: v.array(point) });
const peak = v.nullable(finite);
/** CT values that the volume itself shows for what is known of it; null where no peak was found. */
export const calibrationSchema = v.object({
  air_HU: peak,
  fat_HU: peak,
  soft_tissue_HU: peak,
  cancellous_HU: peak,
  cortical_HU: peak,
  cortex_m: v.nullable(inMetres),
});
export const plannedTractSchema = v.object({
  length_m: inMetres,
  side: v.nullable(v.picklist(['left', 'right'])),
  tract: v.nullable(tractSchema),
  walls: v.array(plannedWallSchema),
  breach: v.nullable(
    v.object({
      wall,
      at_m: inMetres,
      breach_m: point,
      from_m: point,
      tip_m: point,
      depth_m: inMetres,
      inner_m: inMetres,
      wall_thickness_m: inMetres,
    }),
  ),
  problems: v.array(v.string()),
  warnings: v.array(v.string()),
  /** null for published bone; there also when it is refused, so that a person sees why. */
  envelope: v.nullable(envelopeSchema),
  calibration: v.nullable(calibrationSchema),
});
export const makingSchema = v.object({
  id: v.string(),
  volume: v.string(),
  title: v.string(),
  state: v.picklist(['queued', 'running', 'done', 'failed']),
  share: finite,
  phase: v.string(),
  error: v.string(),
  case_id: v.nullable(v.string()),
  made_utc_us: inUtc,
  made_by: v.string(),
});
export const makingListSchema = v.object({ makings: v.array(makingSchema) });

export const kKinds = ['hard', 'soft', 'lateral_breach', 'in_out_in'] as const;
const kind = v.picklist(kKinds);
export const scenarioVersionSchema = v.object({
  id: v.string(),
  name: v.string(),
  kind,
  parent: v.nullable(v.string()),
  published: v.boolean(),
  made_utc_us: inUtc,
  made_by: v.string(),
});
export const scenarioListSchema = v.object({
  scenarios: v.array(scenarioVersionSchema),
  tuned: v.array(v.object({ kind, name: v.string(), id: v.string() })),
});
/** tractus-scenario/1: kept whole, so that what this page does not show is not lost on the way. */
export const scenarioFileSchema = v.looseObject({
  format: v.literal('tractus-scenario/1'),
  name: v.string(),
  kind,
  bone: v.object({ stiffness_N_per_m: finite, damping_Ns_per_m: finite, equilibrium_m: finite, interval_m: finite }),
  breach: v.object({
    resistance_interval_m: finite,
    resistance_factor_per_m: finite,
    breach_interval_m: finite,
    breach_damping_Ns_per_m: finite,
  }),
  walls_m: v.array(finite),
  density: finite,
  layers: v.array(v.object({ start_m: finite, thickness_m: finite, density: finite })),
  travel_m: finite,
  rotary: v.object({ viscous_Nms_per_rad: finite, detent_Nm: finite, detent_pitch_rad: finite }),
});
export const scenarioCheckSchema = v.object({
  ok: v.boolean(),
  field: v.string(),
  error: v.string(),
  excessive: v.array(v.string()),
  curve: v.nullable(
    v.object({
      depth_m: v.array(finite),
      at: v.array(v.object({ speed_m_s: finite, force_N: v.array(finite) })),
      layers: v.array(v.object({ from_m: finite, to_m: finite })),
      walls: v.array(v.object({ from_m: finite, at_m: finite, to_m: finite })),
    }),
  ),
});

export const kReleases = ['held', 'released', 'at_once'] as const;
const assignmentFields = {
  id: v.string(),
  title: v.string(),
  state: v.picklist(['running', 'paused']),
  due_utc_us: v.nullable(inUtc),
  release: v.picklist(kReleases),
  done: count,
  planned: count,
  to_drill: count,
  cohort_id: v.nullable(v.string()),
  cohort_name: v.string(),
  made_utc_us: inUtc,
  made_by: v.string(),
  ordering: v.optional(v.picklist(['fixed', 'random', 'balanced'])),
  repeats: v.optional(count),
  people: v.optional(count),
};
export const releasedAssignmentsSchema = v.object({ assignments: v.array(v.object(assignmentFields)) });
export const assignmentListSchema = v.object({ ...releasedAssignmentsSchema.entries, ...pageFields });
export const assignmentSchema = v.object({
  ...assignmentFields,
  trainees: v.optional(
    v.array(
      v.object({ account_id: v.string(), name: v.string(), participant: v.string(), done: count, planned: count }),
    ),
    [],
  ),
  trials: v.optional(
    v.array(
      v.object({
        trial_id: v.string(),
        participant: v.string(),
        number: count,
        tool: v.picklist(['probe', 'burr']),
        state: v.picklist(['arriving', 'counts', 'invalid', 'surplus']),
        reason: v.string(),
        correct: v.nullable(v.boolean()),
        comments: count,
        started_utc_us: v.nullable(inUtc),
      }),
    ),
    [],
  ),
});

export const commentListSchema = v.object({
  comments: v.array(
    v.object({
      id: v.string(),
      at_s: v.nullable(inSeconds),
      text: v.string(),
      by: v.string(),
      own: v.boolean(),
      made_utc_us: inUtc,
    }),
  ),
});
export const referenceListSchema = v.object({
  reference: v.boolean(),
  trials: v.array(
    v.object({
      id: v.string(),
      operator: v.string(),
      simulated: v.boolean(),
      started_utc_us: inUtc,
      duration_s: inSeconds,
    }),
  ),
});
export const referenceWaySchema = v.object({
  t_s: v.array(finite),
  depth_m: v.array(finite),
  force_N: v.array(inNewtons),
  tip_m: v.nullable(v.array(point)),
});

export type SourceVolume = v.InferOutput<typeof sourceVolumeSchema>;
export type CaseSummary = v.InferOutput<typeof caseSummarySchema>;
export type CaseTruth = v.InferOutput<typeof caseTruthSchema>;
export type Certificate = v.InferOutput<typeof certificateSchema>;
export type WallCertificate = v.InferOutput<typeof wallCertificateSchema>;
export type PlannedTract = v.InferOutput<typeof plannedTractSchema>;
export type Envelope = v.InferOutput<typeof envelopeSchema>;
export type Calibration = v.InferOutput<typeof calibrationSchema>;
export type PlannedWall = v.InferOutput<typeof plannedWallSchema>;
export type Making = v.InferOutput<typeof makingSchema>;
export type ScenarioVersion = v.InferOutput<typeof scenarioVersionSchema>;
export type ScenarioFile = v.InferOutput<typeof scenarioFileSchema>;
export type ScenarioCheck = v.InferOutput<typeof scenarioCheckSchema>;
export type AssignmentSummary = v.InferOutput<typeof assignmentListSchema>['assignments'][number];
export type Assignment = v.InferOutput<typeof assignmentSchema>;
export type Release = (typeof kReleases)[number];
export type TrialComment = v.InferOutput<typeof commentListSchema>['comments'][number];
export type References = v.InferOutput<typeof referenceListSchema>;
export type ReferenceWay = v.InferOutput<typeof referenceWaySchema>;
