/**
 * What the server describes is what is parsed here: the compiler compares the generated types with the schemas.
 * A field that the server drops, renames or makes null turns its line red.
 */
import type * as v from 'valibot';
import type { components } from './generated/schema';
import type {
  effectCheckSchema,
  effectListSchema,
  labRunListSchema,
  labRunSchema,
  labSignalsSchema,
  measurementListSchema,
  modelListSchema,
  sentModelSchema,
} from './lab-schemas';
import type { backupListSchema } from './backup-queries';
import type { changedAccountsSchema, importSchema } from './class-queries';
import type { analysisRunSchema, analysisSchema, lockedPlanSchema, planListSchema } from './cohort-queries';
import type { groupRulesSchema } from './group-queries';
import type {
  accountListSchema,
  auditCheckSchema,
  auditSchema,
  codesSchema,
  cohortListSchema,
  cohortSchema,
  enrolmentSchema,
  invitationListSchema,
  newAccountSchema,
  newPasswordSchema,
  stationListSchema,
} from './network-schemas';
import type { erasurePreviewSchema, erasureSchema, retentionEffectSchema, retentionSchema } from './leaving-queries';
import type { stationPageSchema, stationStateSchema } from './live-schemas';
import type { offerSchema } from './oidc-queries';
import type { cohortProgressSchema, metricsSchema, traineeListSchema } from './trainee-queries';
import type { studyEventsSchema, studyListSchema, studySchema } from './study-schemas';
import type {
  forceDepthSchema,
  pathSchema,
  sessionSchema,
  signalsSchema,
  trialPageSchema,
  trialSchema,
} from './schemas';
import type { savedViewsSchema } from './view-queries';

type Served = components['schemas'];
type Takes<Schema extends v.GenericSchema, Answer> = Answer extends v.InferInput<Schema> ? true : false;

export interface Agreed {
  readonly session: Takes<typeof sessionSchema, Served['Identity']>;
  readonly trials: Takes<typeof trialPageSchema, Served['TrialList']>;
  readonly trial: Takes<typeof trialSchema, Served['Trial']>;
  readonly signals: Takes<typeof signalsSchema, Served['TrialSignals']>;
  readonly path: Takes<typeof pathSchema, Served['TrialPath']>;
  readonly forceDepth: Takes<typeof forceDepthSchema, Served['TrialForceDepth']>;
  readonly studies: Takes<typeof studyListSchema, Served['StudyList']>;
  readonly study: Takes<typeof studySchema, Served['Study']>;
  readonly models: Takes<typeof modelListSchema, Served['ModelList']>;
  readonly measurements: Takes<typeof measurementListSchema, Served['MeasurementsList']>;
  readonly effects: Takes<typeof effectListSchema, Served['EffectList']>;
  readonly effectCheck: Takes<typeof effectCheckSchema, Served['EffectCheck']>;
  readonly labRun: Takes<typeof labRunSchema, Served['LabRun']>;
  readonly labRuns: Takes<typeof labRunListSchema, Served['LabRunList']>;
  readonly labSignals: Takes<typeof labSignalsSchema, Served['RunSignals']>;
  readonly accounts: Takes<typeof accountListSchema, Served['Accounts']>;
  readonly stations: Takes<typeof stationListSchema, Served['Stations']>;
  readonly station: Takes<typeof stationPageSchema, Served['Station']>;
  readonly cohorts: Takes<typeof cohortListSchema, Served['Cohorts']>;
  readonly cohort: Takes<typeof cohortSchema, Served['Cohort']>;
  readonly invitations: Takes<typeof invitationListSchema, Served['Invitations']>;
  readonly audit: Takes<typeof auditSchema, Served['AuditRows']>;
  readonly auditCheck: Takes<typeof auditCheckSchema, Served['AuditCheck']>;
  readonly trainees: Takes<typeof traineeListSchema, Served['TraineeList']>;
  readonly cohortProgress: Takes<typeof cohortProgressSchema, Served['CohortProgressList']>;
  readonly sentModel: Takes<typeof sentModelSchema, Served['SentModel']>;
  readonly backups: Takes<typeof backupListSchema, Served['Backups']>;
  readonly studyEvents: Takes<typeof studyEventsSchema, Served['StudyEvents']>;
  readonly newAccount: Takes<typeof newAccountSchema, Served['NewAccountMade']>;
  readonly groupRules: Takes<typeof groupRulesSchema, Served['GroupRules']>;
  readonly classImport: Takes<typeof importSchema, Served['AccountsImported']>;
  readonly changedAccounts: Takes<typeof changedAccountsSchema, Served['ChangedAccounts']>;
  readonly newPassword: Takes<typeof newPasswordSchema, Served['PasswordMade']>;
  readonly codes: Takes<typeof codesSchema, Served['CodesBegun']>;
  readonly enrolment: Takes<typeof enrolmentSchema, Served['EnrolmentCode']>;
  readonly stationState: Takes<typeof stationStateSchema, Served['StationState']>;
  readonly offer: Takes<typeof offerSchema, Served['OidcOffer']>;
  readonly metrics: Takes<typeof metricsSchema, Served['MetricList']>;
  readonly plans: Takes<typeof planListSchema, Served['PlanList']>;
  readonly analysisRun: Takes<typeof analysisRunSchema, Served['CohortAnalysis']>;
  readonly analysis: Takes<typeof analysisSchema, Served['CohortAnswer']>;
  readonly lockedPlan: Takes<typeof lockedPlanSchema, Served['PlanAnswer']>;
  readonly savedViews: Takes<typeof savedViewsSchema, Served['SavedViews']>;
  readonly erasurePreview: Takes<typeof erasurePreviewSchema, Served['ErasurePreview']>;
  readonly erasure: Takes<typeof erasureSchema, Served['Erasure']>;
  readonly retention: Takes<typeof retentionSchema, Served['Retention']>;
  readonly retentionEffect: Takes<typeof retentionEffectSchema, Served['RetentionEffect']>;
}

export const kAgreed: Agreed = {
  session: true,
  savedViews: true,
  erasurePreview: true,
  erasure: true,
  retention: true,
  retentionEffect: true,
  trials: true,
  trial: true,
  signals: true,
  path: true,
  forceDepth: true,
  studies: true,
  study: true,
  studyEvents: true,
  models: true,
  measurements: true,
  effects: true,
  effectCheck: true,
  labRun: true,
  labRuns: true,
  labSignals: true,
  accounts: true,
  stations: true,
  station: true,
  cohorts: true,
  cohort: true,
  invitations: true,
  audit: true,
  auditCheck: true,
  trainees: true,
  cohortProgress: true,
  sentModel: true,
  backups: true,
  newAccount: true,
  groupRules: true,
  classImport: true,
  changedAccounts: true,
  newPassword: true,
  codes: true,
  enrolment: true,
  stationState: true,
  offer: true,
  metrics: true,
  plans: true,
  analysisRun: true,
  analysis: true,
  lockedPlan: true,
};
