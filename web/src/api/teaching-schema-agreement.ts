/** As schema-agreement.ts, for teaching: what the server describes is what is parsed. */
import type * as v from 'valibot';
import type { components } from './generated/schema';
import type {
  criteriaListSchema,
  curriculaSchema,
  curriculumPeopleSchema,
  expertBoundSchema,
  passingSchema,
} from './criteria-schemas';
import type { pacsImportSchema, pacsSchema, pacsSeriesListSchema, pacsStudiesSchema } from './pacs-queries';
import type { agreementSchema, ratingRequestListSchema, rubricListSchema, trialRatingsSchema } from './rating-schemas';
import type {
  assignmentListSchema,
  assignmentSchema,
  releasedAssignmentsSchema,
  caseListSchema,
  commentListSchema,
  makingListSchema,
  makingSchema,
  plannedCertificateSchema,
  plannedTractSchema,
  referenceListSchema,
  referenceWaySchema,
  caseManifestSchema,
  scenarioCheckSchema,
  scenarioFileSchema,
  scenarioListSchema,
  sourceVolumeListSchema,
} from './teaching-schemas';

type Served = components['schemas'];
type Takes<Schema extends v.GenericSchema, Answer> = Answer extends v.InferInput<Schema> ? true : false;

export interface TeachingAgreed {
  readonly cases: Takes<typeof caseListSchema, Served['CaseList']>;
  readonly making: Takes<typeof makingSchema, Served['CaseMaking']>;
  readonly tract: Takes<typeof plannedTractSchema, Served['PlannedTract']>;
  readonly certificate: Takes<typeof plannedCertificateSchema, Served['PlannedCertificate']>;
  readonly scenarios: Takes<typeof scenarioListSchema, Served['ScenarioVersions']>;
  readonly scenario: Takes<typeof scenarioFileSchema, Served['ScenarioFile']>;
  readonly manifest: Takes<typeof caseManifestSchema, Served['CaseManifest']>;
  readonly check: Takes<typeof scenarioCheckSchema, Served['ScenarioCheck']>;
  readonly assignments: Takes<typeof assignmentListSchema, Served['Assignments']>;
  readonly released: Takes<typeof releasedAssignmentsSchema, Served['ReleasedAssignments']>;
  readonly assignment: Takes<typeof assignmentSchema, Served['Assignment']>;
  readonly comments: Takes<typeof commentListSchema, Served['TrialComments']>;
  readonly references: Takes<typeof referenceListSchema, Served['ReferenceTrials']>;
  readonly way: Takes<typeof referenceWaySchema, Served['ReferenceWay']>;
  readonly makings: Takes<typeof makingListSchema, Served['CaseMakings']>;
  readonly criteria: Takes<typeof criteriaListSchema, Served['CriteriaList']>;
  readonly passing: Takes<typeof passingSchema, Served['Passing']>;
  readonly bound: Takes<typeof expertBoundSchema, Served['ExpertBound']>;
  readonly curricula: Takes<typeof curriculaSchema, Served['Curricula']>;
  readonly curriculumPeople: Takes<typeof curriculumPeopleSchema, Served['CurriculumPeople']>;
  readonly rubrics: Takes<typeof rubricListSchema, Served['RubricList']>;
  readonly ratings: Takes<typeof trialRatingsSchema, Served['TrialRatings']>;
  readonly ratingRequests: Takes<typeof ratingRequestListSchema, Served['RatingRequestList']>;
  readonly agreement: Takes<typeof agreementSchema, Served['RatingAgreements']>;
  readonly volumes: Takes<typeof sourceVolumeListSchema, Served['VolumeList']>;
  readonly pacs: Takes<typeof pacsSchema, Served['Pacs']>;
  readonly pacsStudies: Takes<typeof pacsStudiesSchema, Served['PacsStudies']>;
  readonly pacsSeries: Takes<typeof pacsSeriesListSchema, Served['PacsSeriesList']>;
  readonly pacsImport: Takes<typeof pacsImportSchema, Served['PacsImport']>;
}

export const kTeachingAgreed: TeachingAgreed = {
  cases: true,
  making: true,
  tract: true,
  certificate: true,
  scenarios: true,
  scenario: true,
  manifest: true,
  check: true,
  assignments: true,
  released: true,
  assignment: true,
  comments: true,
  references: true,
  way: true,
  makings: true,
  criteria: true,
  passing: true,
  bound: true,
  curricula: true,
  curriculumPeople: true,
  rubrics: true,
  ratings: true,
  ratingRequests: true,
  agreement: true,
  volumes: true,
  pacs: true,
  pacsStudies: true,
  pacsSeries: true,
  pacsImport: true,
};
