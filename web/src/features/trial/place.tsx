import { Link } from 'wouter';
import type { StudyPlace } from '@/api';
import { Badge } from '@/ui';
import { formatCount } from '@/units';
import styles from './trial-page.module.css';

const kSaid = { arriving: 'arriving', counts: 'counts', invalid: 'does not count', surplus: 'surplus' } as const;

/** Where the trial stands in a study, and whether it counts there. */
export function Place({ place }: { readonly place: StudyPlace }) {
  return (
    <p className={styles.place}>
      <span>Place {formatCount(place.number)} of {place.participant} in <Link href={`/studies/${encodeURIComponent(place.id)}`}>{place.title}</Link></span>
      <Badge tone={place.state === 'counts' ? 'good' : 'warn'}>{kSaid[place.state]}</Badge>
      {place.reason === '' ? null : <span className={styles.reason}>{place.reason}</span>}
    </p>
  );
}
