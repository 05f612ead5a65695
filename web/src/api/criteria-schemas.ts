/** What the server says of passing: criteria, verdicts, curricula and where people stand in them. */
import * as v from 'valibot';
import { share } from '@/units';
import { count, finite, inUtc } from './quantities';

const portion = v.pipe(finite, v.transform(share));
export const kStepStates = ['passed', 'open', 'waiting', 'used_up', 'held'] as const;
export const kBoundMethods = ['mean_sd', 'percentile', 'youden'] as const;

const requirementSchema = v.object({
  kind: v.picklist(['metric', 'recognition', 'lc_cusum']),
  metric: v.optional(v.string()),
  side: v.optional(v.picklist(['at_most', 'at_least'])),
  bound: v.optional(finite),
  times: v.optional(count),
  last: v.optional(count),
  share: v.optional(finite),
  level: v.optional(finite),
  adequate: v.optional(finite),
  inadequate: v.optional(finite),
  basis: v.string(),
  text: v.string(),
});
const made = { reason: v.string(), made_utc_us: inUtc, made_by: v.string() };

export const criteriaListSchema = v.object({
  criteria: v.array(
    v.object({
      kind: v.picklist(['programme', 'case', 'assignment']),
      subject: v.string(),
      title: v.string(),
      versions: v.array(v.object({ version: count, requirements: v.array(requirementSchema), ...made })),
    }),
  ),
  usual: v.array(requirementSchema),
});

const judgedSchema = v.object({ met: v.boolean(), required: v.string(), found: v.string() });
const verdictFields = {
  passed: v.boolean(),
  passed_at: v.nullable(count),
  holds_now: v.boolean(),
  trials: count,
  requirements: v.array(judgedSchema),
};
export const passingSchema = v.object({
  versions: count,
  people: v.array(
    v.object({
      name: v.string(),
      version: count,
      ...verdictFields,
      passed_utc_us: v.nullable(inUtc),
      simulated: v.boolean(),
    }),
  ),
});

const groupSchema = v.object({
  cohort: v.string(),
  people: count,
  simulated: v.boolean(),
  values: v.array(finite),
});
export const expertBoundSchema = v.object({
  bound: finite,
  basis: v.string(),
  experts: groupSchema,
  novices: groupSchema,
  sensitivity: v.nullable(portion),
  specificity: v.nullable(portion),
  area: v.nullable(finite),
});

export const curriculaSchema = v.object({
  curricula: v.array(
    v.object({
      id: v.string(),
      versions: v.array(
        v.object({
          version: count,
          title: v.string(),
          steps: v.array(
            v.object({
              id: v.string(),
              name: v.string(),
              cases: v.array(v.object({ id: v.string(), title: v.string() })),
              repeats: count,
              after: v.array(v.string()),
              requirements: v.array(requirementSchema),
            }),
          ),
          ...made,
        }),
      ),
    }),
  ),
});

export const curriculumPeopleSchema = v.object({
  people: v.array(
    v.object({
      account_id: v.string(),
      name: v.string(),
      curriculum_id: v.string(),
      title: v.string(),
      version: count,
      passed: v.boolean(),
      passed_utc_us: v.nullable(inUtc),
      simulated: v.boolean(),
      next: v.nullable(v.object({ step: v.string(), case: v.nullable(v.string()) })),
      steps: v.array(
        v.object({
          id: v.string(),
          name: v.string(),
          state: v.picklist(kStepStates),
          done: count,
          planned: count,
          assignments: v.array(v.string()),
          rests_on: v.object({
            trials: count,
            first_utc_us: v.nullable(inUtc),
            last_utc_us: v.nullable(inUtc),
            digest: v.string(),
          }),
          ...verdictFields,
        }),
      ),
    }),
  ),
});

export type Requirement = v.InferOutput<typeof requirementSchema>;
export type CriteriaEntry = v.InferOutput<typeof criteriaListSchema>['criteria'][number];
export type CriteriaVersion = CriteriaEntry['versions'][number];
export type PersonPassing = v.InferOutput<typeof passingSchema>['people'][number];
export type ExpertBound = v.InferOutput<typeof expertBoundSchema>;
export type BoundMethod = (typeof kBoundMethods)[number];
export type Curriculum = v.InferOutput<typeof curriculaSchema>['curricula'][number];
export type CurriculumVersion = Curriculum['versions'][number];
export type CurriculumPerson = v.InferOutput<typeof curriculumPeopleSchema>['people'][number];
export type StepProgress = CurriculumPerson['steps'][number];
