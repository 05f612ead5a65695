/** Studies as the server tells them. */
import * as v from 'valibot';
import { count, finite, inSeconds, inUtc } from './quantities';
import { trialStateSchema } from './schemas';

const state = v.picklist(['running', 'paused']);
const ordering = v.picklist(['random', 'balanced']);
const onInvalid = v.picklist(['at_end', 'at_once', 'never']);

const common = {
  id: v.string(),
  title: v.string(),
  state,
  ordering,
  repeats: count,
  on_invalid: onInvalid,
  made_utc_us: inUtc,
  made_by: v.string(),
};

export const studyListSchema = v.object({
  studies: v.array(v.object({ ...common, participants: count, done: count, planned: count })),
});

export const studyTrialSchema = v.object({
  id: v.string(),
  state: v.picklist(['arriving', 'counts', 'invalid', 'surplus']),
  reason: v.string(),
  station: v.string(),
  changed_utc_us: inUtc,
  started_utc_us: v.nullable(inUtc),
  duration_s: v.nullable(inSeconds),
  samples: v.nullable(count),
  sha256: v.nullable(v.string()),
  assessment: v.nullable(trialStateSchema),
  correct: v.nullable(v.boolean()),
});

export const slotSchema = v.object({
  number: count,
  state: v.picklist(['waiting', 'taken', 'recorded', 'invalid']),
  repeat_of: v.nullable(count),
  /** null until the participant is through. */
  scenario: v.nullable(v.string()),
  trials: v.array(studyTrialSchema),
});

export const participantSchema = v.object({
  name: v.string(),
  state,
  level: v.string(),
  experience_years: v.nullable(finite),
  simulated: v.boolean(),
  at_station: v.boolean(),
  last_station: v.nullable(v.string()),
  done: count,
  planned: count,
  judged: count,
  recognised: count,
  slots: v.array(slotSchema),
});

export const studySchema = v.object({
  ...common,
  seed: v.nullable(count),
  scenarios: v.array(v.object({ case_id: v.string(), title: v.string() })),
  participants: v.array(participantSchema),
});

export const studyEventsSchema = v.object({
  events: v.array(
    v.object({
      at_utc_us: inUtc,
      who: v.string(),
      what: v.string(),
      participant: v.nullable(v.string()),
      trial_id: v.nullable(v.string()),
      reason: v.string(),
    }),
  ),
});

export type StudySummary = v.InferOutput<typeof studyListSchema>['studies'][number];
export type Study = v.InferOutput<typeof studySchema>;
export type Participant = v.InferOutput<typeof participantSchema>;
export type Slot = v.InferOutput<typeof slotSchema>;
export type StudyTrial = v.InferOutput<typeof studyTrialSchema>;
export type StudyEvent = v.InferOutput<typeof studyEventsSchema>['events'][number];
export type StudyState = v.InferOutput<typeof state>;
export type Ordering = v.InferOutput<typeof ordering>;
export type OnInvalid = v.InferOutput<typeof onInvalid>;
