import { markTrialInvalid, releaseParticipant, setParticipantState, setStudyState, type Study } from '@/api';
import { say } from '@/language';
import { ReasonDialog } from '@/ui';
import { formatCount } from '@/units';

/** Actions in a running study. */
export type StudyAction =
  | { readonly kind: 'pause-study' | 'resume-study' }
  | { readonly kind: 'pause' | 'resume' | 'release'; readonly participant: string }
  | { readonly kind: 'invalid'; readonly participant: string; readonly trial: string; readonly number: number };

interface Confirmation {
  readonly title: string;
  readonly text: string;
  readonly action: string;
  readonly reasonNeeded: boolean;
  readonly act: (reason: string) => Promise<Study>;
}

function dialogOf(study: string, action: StudyAction): Confirmation {
  switch (action.kind) {
    case 'pause-study':
      return {
        title: say('Pause the study'),
        action: say('Pause'),
        reasonNeeded: false,
        act: (reason) => setStudyState(study, 'paused', reason),
        text: say(
          'No station receives a further trial until the study is resumed. Trials that stations have already reserved can still be done and uploaded.',
        ),
      };
    case 'resume-study':
      return {
        title: say('Resume the study'),
        action: say('Resume'),
        reasonNeeded: false,
        act: (reason) => setStudyState(study, 'running', reason),
        text: say('Stations receive trials again.'),
      };
    case 'pause':
      return {
        title: say('Pause {name}', { name: action.participant }),
        action: say('Pause'),
        reasonNeeded: false,
        act: (reason) => setParticipantState(study, action.participant, 'paused', reason),
        text: say(
          'No station receives a further trial of this participant. A trial that a station has already reserved can still be uploaded.',
        ),
      };
    case 'resume':
      return {
        title: say('Resume {name}', { name: action.participant }),
        action: say('Resume'),
        reasonNeeded: false,
        act: (reason) => setParticipantState(study, action.participant, 'running', reason),
        text: say('Stations receive the trials of this participant again.'),
      };
    case 'release':
      return {
        title: say('Release the reservation for {name}', { name: action.participant }),
        action: say('Release'),
        reasonNeeded: true,
        act: (reason) => releaseParticipant(study, action.participant, reason),
        text: say(
          'Use this for a station that will not return. The next station that asks receives the reserved trial. If the station returns after all, its recordings are kept.',
        ),
      };
    case 'invalid':
      return {
        title: say('Mark trial {number} of {name} as invalid', {
          number: formatCount(action.number),
          name: action.participant,
        }),
        action: say('Mark as invalid'),
        reasonNeeded: true,
        act: (reason) => markTrialInvalid(study, action.trial, reason),
        text: say(
          'The trial is kept with your name and reason. This cannot be undone. The trial is repeated as the study specifies.',
        ),
      };
  }
}

interface Props {
  readonly study: string;
  readonly action: StudyAction;
  readonly onChanged: (next: Study) => void;
  readonly onClose: () => void;
}

export function ActionDialog({ study, action, onChanged, onClose }: Props) {
  const { act, ...texts } = dialogOf(study, action);
  return <ReasonDialog {...texts} onAction={async (reason) => onChanged(await act(reason))} onClose={onClose} />;
}
