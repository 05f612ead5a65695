/** Pages of trainees and their learning. */
import { useQuery } from '@tanstack/react-query';
import { lazy } from 'react';
import { sessionQuery } from '@/api';
import { marked } from '@/language';
import type { Feature } from '@/ui';

const index = () => import('./index');
const CohortsPage = lazy(() => index().then(({ CohortsPage: page }) => ({ default: page })));
const TraineePage = lazy(() => index().then(({ TraineePage: page }) => ({ default: page })));
const TraineesPage = lazy(() => index().then(({ TraineesPage: page }) => ({ default: page })));

/** A trainee's own page. */
function OwnPage() {
  const session = useQuery({ ...sessionQuery, enabled: false }).data;
  return session ? <TraineePage name={session.name} /> : null;
}

export const feature: Feature = {
  menu: [
    { to: '/trainees', name: marked('Trainees'), roles: ['admin', 'director', 'faculty'], order: 60 },
    { to: '/me', name: marked('My progress'), roles: ['trainee'], order: 70 },
  ],
  pages: [
    { path: '/cohorts', show: () => <CohortsPage /> },
    { path: '/me', show: () => <OwnPage /> },
    { path: '/trainees', show: () => <TraineesPage /> },
    { path: '/trainees/:name', show: (at) => <TraineePage key={at('name')} name={decodeURIComponent(at('name'))} /> },
  ],
};
