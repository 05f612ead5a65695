/** Pages of people, cohorts, stations, backups and the audit trail. */
import { useQuery } from '@tanstack/react-query';
import { lazy } from 'react';
import { Redirect } from 'wouter';
import { sessionQuery } from '@/api';
import { marked } from '@/language';
import type { Feature } from '@/ui';

const index = () => import('./index');
const AuditPage = lazy(() => index().then(({ AuditPage: page }) => ({ default: page })));
const BackupsPage = lazy(() => index().then(({ BackupsPage: page }) => ({ default: page })));
const CohortsPage = lazy(() => index().then(({ CohortsPage: page }) => ({ default: page })));
const LeavingPage = lazy(() => index().then(({ LeavingPage: page }) => ({ default: page })));
const PeoplePage = lazy(() => index().then(({ PeoplePage: page }) => ({ default: page })));
const RetentionPage = lazy(() => index().then(({ RetentionPage: page }) => ({ default: page })));
const StationPage = lazy(() => index().then(({ StationPage: page }) => ({ default: page })));
const StationsPage = lazy(() => index().then(({ StationsPage: page }) => ({ default: page })));

const kFirst: Record<string, string> = { admin: 'people', technician: 'stations' };

/** Each role begins with the page that it needs most. */
function FirstPage() {
  const role = useQuery({ ...sessionQuery, enabled: false }).data?.role ?? '';
  return <Redirect to={`/network/${kFirst[role] ?? 'cohorts'}`} replace />;
}

export const feature: Feature = {
  menu: [
    { to: '/network', name: marked('Network'), roles: ['admin', 'director', 'faculty', 'technician'], order: 120 },
  ],
  pages: [
    { path: '/network', show: () => <FirstPage /> },
    { path: '/network/people', show: () => <PeoplePage /> },
    { path: '/network/people/:id/leaving', show: (at) => <LeavingPage key={at('id')} id={at('id')} /> },
    { path: '/network/retention', show: () => <RetentionPage /> },
    { path: '/network/cohorts', show: () => <CohortsPage /> },
    { path: '/network/stations', show: () => <StationsPage /> },
    { path: '/network/stations/:id', show: (at) => <StationPage key={at('id')} id={at('id')} /> },
    { path: '/network/backups', show: () => <BackupsPage /> },
    { path: '/network/audit', show: () => <AuditPage /> },
  ],
};
