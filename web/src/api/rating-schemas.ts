/** What the server says of ratings by people: rubrics, what is to be rated, what was said, how far raters agree. */
import * as v from 'valibot';
import { count, finite, inUtc } from './quantities';

const itemSchema = v.object({
  label: v.string(),
  text: v.string(),
  low: count,
  high: count,
  low_text: v.string(),
  middle_text: v.string(),
  high_text: v.string(),
});
const rubricSchema = v.object({
  id: v.string(),
  version: count,
  title: v.string(),
  items: v.array(itemSchema),
  reason: v.string(),
  made_utc_us: inUtc,
  made_by: v.string(),
});
export const rubricListSchema = v.object({ rubrics: v.array(rubricSchema) });

export const trialRatingsSchema = v.object({
  requests: v.array(
    v.object({
      rubric: rubricSchema,
      blind: v.boolean(),
      raters: count,
      submitted: count,
      complete: v.boolean(),
      may_rate: v.boolean(),
      ratings: v.array(
        v.object({
          rater: v.string(),
          own: v.boolean(),
          scores: v.array(count),
          total: count,
          comment: v.string(),
          reason: v.string(),
          independent: v.boolean(),
          holds: v.boolean(),
          made_utc_us: inUtc,
        }),
      ),
    }),
  ),
});

export const ratingRequestListSchema = v.object({
  requests: v.array(
    v.object({
      trial_id: v.string(),
      case_title: v.string(),
      simulated: v.boolean(),
      started_utc_us: inUtc,
      rubric_id: v.string(),
      rubric_title: v.string(),
      version: count,
      blind: v.boolean(),
      raters: count,
      submitted: count,
      own: v.boolean(),
    }),
  ),
});

const agreementFields = {
  single: v.nullable(finite),
  single_low: v.nullable(finite),
  single_high: v.nullable(finite),
  mean: v.nullable(finite),
  mean_low: v.nullable(finite),
  mean_high: v.nullable(finite),
  kappa: v.nullable(finite),
  note: v.string(),
};
export const agreementSchema = v.object({
  title: v.string(),
  groups: v.array(
    v.object({
      raters: v.array(v.string()),
      trials: count,
      simulated: v.boolean(),
      total: v.object(agreementFields),
      items: v.array(v.object({ ...agreementFields, label: v.string() })),
      totals: v.array(v.array(finite)),
      differences: v.nullable(v.object({ mean: finite, low: finite, high: finite })),
    }),
  ),
});

export type Rubric = v.InferOutput<typeof rubricSchema>;
export type RubricItem = Rubric['items'][number];
export type RatingRequest = v.InferOutput<typeof trialRatingsSchema>['requests'][number];
export type Rating = RatingRequest['ratings'][number];
export type ListedRequest = v.InferOutput<typeof ratingRequestListSchema>['requests'][number];
export type RaterGroup = v.InferOutput<typeof agreementSchema>['groups'][number];
export type Agreement = RaterGroup['total'];
