import { Link } from 'wouter';
import type { Assignment } from '@/api';
import { Badge, Button, DataTable } from '@/ui';
import { formatCount, formatDateTime } from '@/units';
import styles from './assignments.module.css';

type Done = Assignment['trials'][number];

const kStates: Record<Done['state'], string> = {
  arriving: 'uploading',
  counts: 'valid',
  invalid: 'invalid',
  surplus: 'surplus',
};

function State({ trial }: { readonly trial: Done }) {
  return (
    <span>
      {trial.state === 'counts' ? kStates.counts : <Badge tone="warn">{kStates[trial.state]}</Badge>}
      {trial.reason ? <span className={styles.muted}> {trial.reason}</span> : null}
    </span>
  );
}

const answer = ({ correct }: Done) =>
  correct === null ? '–' : correct ? <Badge tone="good">correct</Badge> : <Badge tone="bad">incorrect</Badge>;

interface Props {
  readonly one: Assignment;
  readonly may: boolean;
  readonly own?: boolean;
  readonly onInvalid?: (trial: string) => void;
}

/** Trials that arrived: of all, or one's own. */
export function TrialsTable({ one, may, own = false, onInvalid }: Props) {
  const names = new Map(one.trainees.map(({ participant, name }) => [participant, name]));
  const named = (trial: Done) => `trial ${formatCount(trial.number)}${trial.tool === 'burr' ? ', drilling' : ''}`;
  const whose = (trial: Done) => (own ? '' : `${names.get(trial.participant) ?? trial.participant}, `);
  const link = (trial: Done) => (
    <Link href={`/trials/${trial.trial_id}/debrief`} aria-label={`Debrief: ${whose(trial)}${named(trial)}`}>
      Debrief
    </Link>
  );
  return (
    <DataTable<Done>
      caption="Trials"
      rows={one.trials}
      keyOf={({ trial_id }) => trial_id}
      empty={`No trials have been uploaded yet${own ? '' : ', or all are being rated blind'}.`}
      minWidth={own ? 480 : 680}
      {...(own ? {} : { filter: { label: 'Filter by trainee', text: whose } })}
      columns={[
        {
          name: 'Trial',
          by: (trial) => `${whose(trial)}${named(trial)}`,
          cell: (trial) => (
            <>
              {whose(trial)}
              {named(trial)}
            </>
          ),
        },
        {
          name: 'Date',
          by: (trial) => trial.started_utc_us,
          cell: (trial) => (trial.started_utc_us === null ? '–' : formatDateTime(trial.started_utc_us)),
        },
        { name: 'Answer', by: (trial) => trial.correct, cell: answer },
        { name: 'Comments', by: (trial) => trial.comments, cell: (trial) => formatCount(trial.comments), number: true },
        { name: 'State', by: (trial) => kStates[trial.state], cell: (trial) => <State trial={trial} /> },
        {
          name: <span className="hidden-visually">Actions</span>,
          cell: (trial) => (
            <span className={styles.buttons}>
              {trial.state === 'arriving' ? null : link(trial)}
              {may && trial.state === 'counts' ? (
                <Button
                  look="quiet"
                  label={`Mark as invalid: ${named(trial)} of ${names.get(trial.participant) ?? trial.participant}`}
                  onClick={() => onInvalid?.(trial.trial_id)}
                >
                  Mark as invalid…
                </Button>
              ) : null}
            </span>
          ),
        },
      ]}
    />
  );
}
