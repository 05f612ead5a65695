import type { AssignmentSummary } from '@/api';
import { Badge, Progress } from '@/ui';
import { formatCount, formatDateTime } from '@/units';
import styles from './assignments.module.css';
import { drillingLabel, dueState } from './labels';

export function DueDate({ one, now_us }: { readonly one: AssignmentSummary; readonly now_us: number }) {
  if (one.due_utc_us === null) return <span className={styles.muted}>no due date</span>;
  const how = dueState(one, now_us);
  return (
    <span className={styles.due}>
      {formatDateTime(one.due_utc_us)}
      {how === 'late' ? <Badge tone="bad">overdue</Badge> : how === 'soon' ? <Badge tone="warn">due soon</Badge> : null}
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
      <span>
        {formatCount(done)} of {formatCount(planned)}
      </span>
    </span>
  );
}
