import { Link } from 'wouter';
import type { StudyPlace } from '@/api';
import { marked, say, Sentence } from '@/language';
import { Badge } from '@/ui';
import { formatCount } from '@/units';
import styles from './trial-page.module.css';

const kStateLabels = {
  arriving: marked('uploading'),
  counts: marked('valid'),
  invalid: marked('invalid'),
  surplus: marked('surplus'),
} as const;

/** A trial belongs to a study or to an assignment; the ids of assignments begin with "a-". */
export const seriesAddress = (id: string) =>
  id.startsWith('a-') ? `/assignments/${encodeURIComponent(id)}` : `/studies/${encodeURIComponent(id)}`;

/** Position of the trial in its study or assignment, and whether it is valid; by the person's name where it is known. */
export function StudyPosition({ position, person }: { readonly position: StudyPlace; readonly person: string }) {
  return (
    <p className={styles.place}>
      <span>
        <Sentence
          text="Trial {number} of {person} in <link>{title}</link>"
          values={{
            number: formatCount(position.number),
            person: person || position.participant,
            title: position.title,
          }}
          parts={{ link: (words) => <Link href={seriesAddress(position.id)}>{words}</Link> }}
        />
      </span>
      <Badge tone={position.state === 'counts' ? 'good' : 'warn'}>{say(kStateLabels[position.state])}</Badge>
      {position.reason === '' ? null : <span className={styles.reason}>{position.reason}</span>}
    </p>
  );
}
