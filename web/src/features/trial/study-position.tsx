import { Link } from 'wouter';
import type { StudyPlace } from '@/api';
import { Badge } from '@/ui';
import { formatCount } from '@/units';
import styles from './trial-page.module.css';

const kStateLabels = { arriving: 'uploading', counts: 'valid', invalid: 'invalid', surplus: 'surplus' } as const;

/** A trial belongs to a study or to an assignment; the ids of assignments begin with "a-". */
export const seriesAddress = (id: string) =>
  id.startsWith('a-') ? `/assignments/${encodeURIComponent(id)}` : `/studies/${encodeURIComponent(id)}`;

/** Position of the trial in its study or assignment, and whether it is valid; by the person's name where it is known. */
export function StudyPosition({ position, person }: { readonly position: StudyPlace; readonly person: string }) {
  return (
    <p className={styles.place}>
      <span>
        Trial {formatCount(position.number)} of {person || position.participant} in{' '}
        <Link href={seriesAddress(position.id)}>{position.title}</Link>
      </span>
      <Badge tone={position.state === 'counts' ? 'good' : 'warn'}>{kStateLabels[position.state]}</Badge>
      {position.reason === '' ? null : <span className={styles.reason}>{position.reason}</span>}
    </p>
  );
}
