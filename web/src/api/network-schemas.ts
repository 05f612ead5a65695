/** What the server says of accounts, stations, cohorts and the audit trail. */
import * as v from 'valibot';
import { pageFields } from './lists';
import { stationStateFields } from './live-schemas';
import { count, inUtc } from './quantities';

export const kRoles = ['admin', 'director', 'faculty', 'researcher', 'technician', 'trainee'] as const;

export const accountSchema = v.object({
  id: v.string(),
  name: v.string(),
  role: v.string(),
  state: v.picklist(['active', 'disabled']),
  badge: v.nullable(v.string()),
  has_pin: v.boolean(),
  has_codes: v.boolean(),
  must_change: v.boolean(),
  level: v.string(),
  made_utc_us: inUtc,
});
export const accountListSchema = v.object({ accounts: v.array(accountSchema), ...pageFields });
export const newAccountSchema = v.object({ account: accountSchema, password: v.nullable(v.string()) });
export const newPasswordSchema = v.object({ password: v.string() });
export const codesSchema = v.object({ secret: v.string(), uri: v.string() });

export const stationSchema = v.object({
  ...stationStateFields,
  enrolled_utc_us: inUtc,
  revoked_utc_us: v.nullable(inUtc),
});
export const stationListSchema = v.object({ stations: v.array(stationSchema) });
export const enrolmentSchema = v.object({ name: v.string(), code: v.string(), expires_utc_us: inUtc });

const cohortFields = { id: v.string(), name: v.string(), trainees: count, made_utc_us: inUtc, made_by: v.string() };
export const cohortListSchema = v.object({ cohorts: v.array(v.object(cohortFields)) });
export const cohortSchema = v.object({
  ...cohortFields,
  people: v.array(
    v.object({ account_id: v.string(), name: v.string(), part: v.picklist(['trainee', 'faculty']), state: v.string() }),
  ),
  invitations: v.array(v.object({ name: v.string(), made_utc_us: inUtc, made_by: v.string() })),
});
/** Cohorts that the signed-in person is asked into. */
export const invitationListSchema = v.object({
  invitations: v.array(
    v.object({ cohort_id: v.string(), cohort_name: v.string(), made_utc_us: inUtc, made_by: v.string() }),
  ),
});

export const auditSchema = v.object({
  rows: v.array(
    v.object({
      number: count,
      at_utc_us: inUtc,
      who: v.string(),
      role: v.string(),
      peer: v.string(),
      what: v.string(),
      object: v.string(),
      detail: v.record(v.string(), v.unknown()),
      hash: v.string(),
    }),
  ),
  ...pageFields,
});
export const auditCheckSchema = v.object({
  holds: v.boolean(),
  rows: v.nullable(count),
  hash: v.nullable(v.string()),
  failure: v.nullable(v.string()),
});

export type Account = v.InferOutput<typeof accountSchema>;
export type Role = (typeof kRoles)[number];
export type Station = v.InferOutput<typeof stationSchema>;
export type Enrolment = v.InferOutput<typeof enrolmentSchema>;
export type CohortSummary = v.InferOutput<typeof cohortListSchema>['cohorts'][number];
export type Cohort = v.InferOutput<typeof cohortSchema>;
export type Invitation = v.InferOutput<typeof invitationListSchema>['invitations'][number];
export type AuditRow = v.InferOutput<typeof auditSchema>['rows'][number];
export type AuditCheck = v.InferOutput<typeof auditCheckSchema>;
export type Codes = v.InferOutput<typeof codesSchema>;
