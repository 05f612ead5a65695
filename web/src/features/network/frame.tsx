import { useQuery } from '@tanstack/react-query';
import type { ReactNode } from 'react';
import { sessionQuery } from '@/api';
import { marked, say } from '@/language';
import { TabbedPage } from '@/ui';

const kPlaces = [
  { at: 'people', name: marked('Accounts'), roles: ['admin'] },
  { at: 'cohorts', name: marked('Cohorts'), roles: ['admin', 'director', 'faculty'] },
  { at: 'stations', name: marked('Stations'), roles: ['admin', 'technician', 'faculty'] },
  { at: 'backups', name: marked('Backups'), roles: ['admin', 'technician'] },
  { at: 'retention', name: marked('Retention'), roles: ['admin', 'director'] },
  { at: 'audit', name: marked('Audit trail'), roles: ['admin'] },
] as const;
type Place = (typeof kPlaces)[number]['at'];

const addressOf = (place: Place) => `/network/${place}`;

/** What the pages of the network have in common: tabs to those that a role may see. */
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
  const tabs = kPlaces
    .filter((place) => place.at === at || (place.roles as readonly string[]).includes(role))
    .map((place) => ({ to: addressOf(place.at), name: place.name }));
  return (
    <TabbedPage tabs={tabs} at={addressOf(at)} label={say('Network')} lead={lead}>
      {children}
    </TabbedPage>
  );
}
