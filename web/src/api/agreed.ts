/**
 * What the server describes is what is parsed here: the compiler compares the generated types with the schemas.
 * A field that the server drops, renames or makes null turns its line red.
 */
import type * as v from 'valibot';
import type { components } from './generated/schema';
import type { studyEventsSchema, studyListSchema, studySchema } from './study-schemas';
import type { forceDepthSchema, pathSchema, sessionSchema, signalsSchema, trialPageSchema, trialSchema } from './schemas';

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
  readonly studyEvents: Takes<typeof studyEventsSchema, Served['StudyEvents']>;
}

export const kAgreed: Agreed = { session: true, trials: true, trial: true, signals: true, path: true, forceDepth: true, studies: true, study: true, studyEvents: true };
