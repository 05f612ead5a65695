import { markTrialInvalid, releaseParticipant, setParticipantState, setStudyState, type Study } from '@/api';
import { ReasonDialog } from '@/ui';
import { formatCount } from '@/units';

/** What can be decided in a running study. */
export type Deed =
  | { readonly kind: 'pause-study' | 'resume-study' }
  | { readonly kind: 'pause' | 'resume' | 'release'; readonly participant: string }
  | { readonly kind: 'invalid'; readonly participant: string; readonly trial: string; readonly number: number };

interface Asked { readonly title: string; readonly text: string; readonly deed: string; readonly reasonNeeded: boolean; readonly act: (reason: string) => Promise<Study> }

function asked(study: string, deed: Deed): Asked {
  switch (deed.kind) {
    case 'pause-study': return {
      title: 'Pause the study', deed: 'Pause', reasonNeeded: false, act: (reason) => setStudyState(study, 'paused', reason),
      text: 'No station gets a further trial until the study goes on. Trials that stations already hold may still be done and come in.',
    };
    case 'resume-study': return {
      title: 'Go on with the study', deed: 'Go on', reasonNeeded: false, act: (reason) => setStudyState(study, 'running', reason),
      text: 'Stations get trials again.',
    };
    case 'pause': return {
      title: `Pause ${deed.participant}`, deed: 'Pause', reasonNeeded: false, act: (reason) => setParticipantState(study, deed.participant, 'paused', reason),
      text: 'No station gets a further trial of this participant. What a station already holds may still come in.',
    };
    case 'resume': return {
      title: `Go on with ${deed.participant}`, deed: 'Go on', reasonNeeded: false, act: (reason) => setParticipantState(study, deed.participant, 'running', reason),
      text: 'Stations get this participant’s trials again.',
    };
    case 'release': return {
      title: `Release the trials of ${deed.participant}`, deed: 'Release', reasonNeeded: true, act: (reason) => releaseParticipant(study, deed.participant, reason),
      text: 'For a station that will not come back: what it holds is handed to the next one that asks. If it comes back after all, its trials are kept.',
    };
    case 'invalid': return {
      title: `Trial ${formatCount(deed.number)} of ${deed.participant} does not count`, deed: 'Mark as invalid', reasonNeeded: true,
      act: (reason) => markTrialInvalid(study, deed.trial, reason),
      text: 'The trial stays where it is, with your name and reason, and cannot be made to count again. Its place is repeated as the study says.',
    };
  }
}

interface Props { readonly study: string; readonly deed: Deed; readonly onChanged: (next: Study) => void; readonly onClose: () => void }

export function DeedDialog({ study, deed, onChanged, onClose }: Props) {
  const { act, ...words } = asked(study, deed);
  return <ReasonDialog {...words} onDeed={async (reason) => onChanged(await act(reason))} onClose={onClose} />;
}
