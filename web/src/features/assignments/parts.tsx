import type { AssignmentSummary } from '@/api';
import { say } from '@/language';
import { Badge, Progress } from '@/ui';
import { formatCount, formatDateTime } from '@/units';
import styles from './assignments.module.css';
import { drillingLabel, dueState } from './labels';

export function DueDate({ one, now_us }: { readonly one: AssignmentSummary; readonly now_us: number }) {
  if (one.due_utc_us === null) return <span className={styles.muted}>{say('no due date')}</span>;
  const how = dueState(one, now_us);
  return (
    <span className={styles.due}>
      {formatDateTime(one.due_utc_us)}
      {how === 'late' ? (
        <Badge tone="bad">{say('overdue')}</Badge>
      ) : how === 'soon' ? (
        <Badge tone="warn">{say('due soon')}</Badge>
      ) : null}
    </span>
  );
}

export function Drilling({ one }: { readonly one: AssignmentSummary }) {
  const label = drillingLabel(one);
  return label === '' ? null : <span className={styles.drilling}>{label}</span>;
}

export function Done({
  done,
  planned,
  label,
}: {
  readonly done: number;
  readonly planned: number;
  readonly label: string;
}) {
  return (
    <span className={styles.done}>
      <Progress done={done} of={planned} label={label} />
      <span>{say('{done} of {planned}', { done: formatCount(done), planned: formatCount(planned) })}</span>
    </span>
  );
}
