import { Link } from 'wouter';
import type { Assignment } from '@/api';
import { marked, say } from '@/language';
import { Badge, Button, DataTable } from '@/ui';
import { formatCount, formatDateTime } from '@/units';
import styles from './assignments.module.css';

type Done = Assignment['trials'][number];

const kStates: Record<Done['state'], string> = {
  arriving: marked('uploading'),
  counts: marked('valid'),
  invalid: marked('invalid'),
  surplus: marked('surplus'),
};

function State({ trial }: { readonly trial: Done }) {
  return (
    <span>
      {trial.state === 'counts' ? say(kStates.counts) : <Badge tone="warn">{say(kStates[trial.state])}</Badge>}
      {trial.reason ? <span className={styles.muted}> {trial.reason}</span> : null}
    </span>
  );
}

const answer = ({ correct }: Done) =>
  correct === null ? (
    '–'
  ) : correct ? (
    <Badge tone="good">{say('correct')}</Badge>
  ) : (
    <Badge tone="bad">{say('incorrect')}</Badge>
  );

interface Props {
  readonly one: Assignment;
  readonly may: boolean;
  readonly own?: boolean;
  readonly onInvalid?: (trial: string) => void;
}

/** Trials that arrived: of all, or one's own. */
export function TrialsTable({ one, may, own = false, onInvalid }: Props) {
  const names = new Map(one.trainees.map(({ participant, name }) => [participant, name]));
  const named = (trial: Done) =>
    trial.tool === 'burr'
      ? say('trial {number}, drilling', { number: formatCount(trial.number) })
      : say('trial {number}', { number: formatCount(trial.number) });
  const whose = (trial: Done) => (own ? '' : `${names.get(trial.participant) ?? trial.participant}, `);
  const link = (trial: Done) => (
    <Link
      href={`/trials/${trial.trial_id}/debrief`}
      aria-label={say('Debrief: {trial}', { trial: `${whose(trial)}${named(trial)}` })}
    >
      {say('Debrief')}
    </Link>
  );
  return (
    <DataTable<Done>
      caption={say('Trials')}
      rows={one.trials}
      keyOf={({ trial_id }) => trial_id}
      empty={
        own
          ? say('No trials have been uploaded yet.')
          : say('No trials have been uploaded yet, or all are being rated blind.')
      }
      minWidth={own ? 480 : 680}
      {...(own ? {} : { filter: { label: say('Filter by trainee'), text: whose } })}
      columns={[
        {
          name: say('Trial'),
          by: (trial) => `${whose(trial)}${named(trial)}`,
          cell: (trial) => (
            <>
              {whose(trial)}
              {named(trial)}
            </>
          ),
        },
        {
          name: say('Date'),
          by: (trial) => trial.started_utc_us,
          cell: (trial) => (trial.started_utc_us === null ? '–' : formatDateTime(trial.started_utc_us)),
        },
        { name: say('Answer'), by: (trial) => trial.correct, cell: answer },
        {
          name: say('Comments'),
          by: (trial) => trial.comments,
          cell: (trial) => formatCount(trial.comments),
          number: true,
        },
        { name: say('State'), by: (trial) => say(kStates[trial.state]), cell: (trial) => <State trial={trial} /> },
        {
          name: <span className="hidden-visually">{say('Actions')}</span>,
          cell: (trial) => (
            <span className={styles.buttons}>
              {trial.state === 'arriving' ? null : link(trial)}
              {may && trial.state === 'counts' ? (
                <Button
                  look="quiet"
                  label={say('Mark as invalid: {trial} of {name}', {
                    trial: named(trial),
                    name: names.get(trial.participant) ?? trial.participant,
                  })}
                  onClick={() => onInvalid?.(trial.trial_id)}
                >
                  {say('Mark as invalid…')}
                </Button>
              ) : null}
            </span>
          ),
        },
      ]}
    />
  );
}
