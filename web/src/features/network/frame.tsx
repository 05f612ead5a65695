import { useQuery } from '@tanstack/react-query';
import type { ReactNode } from 'react';
import { sessionQuery } from '@/api';
import { TabbedPage } from '@/ui';

const kPlaces = [
  { at: 'people', name: 'Accounts', roles: ['admin'] },
  { at: 'cohorts', name: 'Cohorts', roles: ['admin', 'director', 'faculty'] },
  { at: 'stations', name: 'Stations', roles: ['admin', 'technician', 'faculty'] },
  { at: 'backups', name: 'Backups', roles: ['admin', 'technician'] },
  { at: 'retention', name: 'Retention', roles: ['admin', 'director'] },
  { at: 'audit', name: 'Audit trail', roles: ['admin'] },
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
    <TabbedPage tabs={tabs} at={addressOf(at)} label="Network" lead={lead}>
      {children}
    </TabbedPage>
  );
}
