import { useQuery } from '@tanstack/react-query';
import type { ReactNode } from 'react';
import { Link } from 'wouter';
import { sessionQuery } from '@/api';
import { useTitle } from '@/ui';
import styles from './network.module.css';

const kPlaces = [
  { at: 'people', name: 'Accounts', roles: ['admin'] },
  { at: 'cohorts', name: 'Cohorts', roles: ['admin', 'director', 'faculty'] },
  { at: 'stations', name: 'Stations', roles: ['admin', 'technician', 'faculty'] },
  { at: 'backups', name: 'Backups', roles: ['admin', 'technician'] },
  { at: 'audit', name: 'Audit trail', roles: ['admin'] },
] as const;
type Place = (typeof kPlaces)[number]['at'];

/** What stands round the pages of the network: its title, and the ways between them that a role has. */
export function Frame({
  at,
  lead,
  children,
}: {
  readonly at: Place;
  readonly lead: string;
  readonly children: ReactNode;
}) {
  const role = useQuery({ ...sessionQuery, enabled: false }).data?.role ?? '';
  const here = kPlaces.find((place) => place.at === at)?.name ?? '';
  useTitle(here);
  const open = kPlaces.filter(({ roles }) => (roles as readonly string[]).includes(role));
  return (
    <div className={styles.page}>
      <div>
        <h1>{here}</h1>
        <p className={styles.lead}>{lead}</p>
      </div>
      {open.length > 1 ? (
        <nav aria-label="Network" className={styles.tabs}>
          {open.map((place) => (
            <Link key={place.at} href={`/network/${place.at}`} aria-current={place.at === at ? 'page' : undefined}>
              {place.name}
            </Link>
          ))}
        </nav>
      ) : null}
      {children}
    </div>
  );
}
