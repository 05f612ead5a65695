import { Link } from 'wouter';
import type { TrialSummary } from '@/api';
import { Badge, Skeleton } from '@/ui';
import { formatDateTime, formatDuration, isoDateTime } from '@/units';
import styles from './trials-table.module.css';

const kWaiting = 8;
const kColumns = ['Started', 'Case', 'Operator', 'Station', 'Duration', 'Answer', 'State'] as const;

function AnswerCell({ trial }: { readonly trial: TrialSummary }) {
  if (trial.correct === true) return <Badge tone="good">✓ correct</Badge>;
  if (trial.correct === false) return <Badge tone="bad">✗ incorrect</Badge>;
  return <span className={styles.none}>{trial.state === 'assessed' ? 'none' : '–'}</span>;
}

function StateCell({ trial }: { readonly trial: TrialSummary }) {
  switch (trial.state) {
    case 'assessing':
      return <Badge tone="accent">assessing…</Badge>;
    case 'failed':
      return <Badge tone="bad">failed</Badge>;
    case 'assessed':
      return <span className={styles.none}>assessed</span>;
  }
}

function Row({ trial }: { readonly trial: TrialSummary }) {
  return (
    <tr>
      <td>
        <time dateTime={isoDateTime(trial.started_utc_us)}>{formatDateTime(trial.started_utc_us)}</time>
      </td>
      <td>
        <Link href={`/trials/${encodeURIComponent(trial.id)}`} className={styles.link}>
          {trial.case_title}
        </Link>
      </td>
      <td>
        <span className={styles.operator}>
          {trial.operator_name}
          {trial.simulated ? <Badge tone="warn">simulated</Badge> : null}
        </span>
      </td>
      <td>{trial.station}</td>
      <td className={styles.number}>{formatDuration(trial.duration_s)}</td>
      <td>
        <AnswerCell trial={trial} />
      </td>
      <td>
        <StateCell trial={trial} />
      </td>
    </tr>
  );
}

function WaitingRow() {
  return (
    <tr>
      {kColumns.map((column) => (
        <td key={column}>
          <Skeleton width="80%" />
        </td>
      ))}
    </tr>
  );
}

/** `undefined` while loading: rows of the same height hold the place. */
export function TrialsTable({ trials }: { readonly trials: readonly TrialSummary[] | undefined }) {
  return (
    <div className={styles.frame}>
      <table className={styles.table} aria-busy={trials === undefined}>
        <caption className="hidden-visually">Trials, newest first</caption>
        <thead>
          <tr>
            {kColumns.map((column) => (
              <th key={column} scope="col" className={column === 'Duration' ? styles.number : undefined}>
                {column}
              </th>
            ))}
          </tr>
        </thead>
        <tbody>
          {trials === undefined
            ? Array.from({ length: kWaiting }, (_, index) => <WaitingRow key={index} />)
            : trials.map((trial) => <Row key={trial.id} trial={trial} />)}
        </tbody>
      </table>
    </div>
  );
}
