/** Stations as they are now, and what they say of themselves. */
import * as v from 'valibot';
import { count, inUtc } from './quantities';

export const kStationStates = ['away', 'idle', 'preparing', 'trial', 'questions', 'stopped', 'fault'] as const;
const number = v.pipe(v.number(), v.finite());
/** Absent and null both mean: not known. */
const known = <Schema extends v.GenericSchema>(schema: Schema) => v.nullish(schema, null);

const runningTrialSchema = v.object({
  trial_id: v.string(),
  rig: v.string(),
  case_title: known(v.string()),
  person: known(v.string()),
  t_s: number,
  samples: count,
  force_N: known(number),
  depth_m: known(number),
  late_ticks: count,
});
const selfTestSchema = v.object({ at_utc_us: inUtc, passed: v.boolean(), failed: v.array(v.string()) });

/** A station that has never been heard of is away. */
export const stationStateFields = {
  id: v.string(),
  name: v.string(),
  connected: v.optional(v.boolean(), false),
  state: v.optional(v.picklist(kStationStates), 'away'),
  since_utc_us: known(inUtc),
  last_seen_utc_us: known(inUtc),
  version: known(v.string()),
  device: known(v.string()),
  simulated: known(v.boolean()),
  trial: known(runningTrialSchema),
  clock_offset_s: known(number),
  free_disk_bytes: known(count),
  late_share: known(number),
  waiting_trials: known(count),
  calibration_due_utc_us: known(inUtc),
  self_test: known(selfTestSchema),
};
export const stationStateSchema = v.object(stationStateFields);

/** What comes over the socket: all at once, then one at a time. Other kinds are for pages of later releases. */
export const liveMessageSchema = v.variant('kind', [
  v.object({ kind: v.literal('stations'), stations: v.array(stationStateSchema) }),
  v.object({ kind: v.literal('station'), station: stationStateSchema }),
]);

const checkSchema = v.object({
  name: v.string(),
  passed: v.boolean(),
  value: known(number),
  unit: v.optional(v.string(), ''),
  limit: known(number),
  words: v.optional(v.string(), ''),
});
export const stationPageSchema = v.object({
  ...stationStateFields,
  enrolled_utc_us: inUtc,
  revoked_utc_us: known(inUtc),
  self_tests: v.optional(
    v.array(v.object({ at_utc_us: inUtc, passed: v.boolean(), checks: v.array(checkSchema) })),
    [],
  ),
  calibrations: v.optional(
    v.array(
      v.object({ at_utc_us: inUtc, due_utc_us: known(inUtc), kind: v.string(), words: v.optional(v.string(), '') }),
    ),
    [],
  ),
});

export type StationState = v.InferOutput<typeof stationStateSchema>;
export type StationPage = v.InferOutput<typeof stationPageSchema>;
export type LiveMessage = v.InferOutput<typeof liveMessageSchema>;
