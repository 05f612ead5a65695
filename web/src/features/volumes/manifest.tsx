/** CT volumes: uploaded, looked at, released for making cases or refused. */
import { lazy } from 'react';
import { marked } from '@/language';
import type { Feature } from '@/ui';

const index = () => import('./index');
const VolumePage = lazy(() => index().then(({ VolumePage: page }) => ({ default: page })));
const VolumesPage = lazy(() => index().then(({ VolumesPage: page }) => ({ default: page })));

export const feature: Feature = {
  menu: [{ to: '/volumes', name: marked('Volumes'), roles: ['admin', 'director', 'faculty', 'researcher'], order: 25 }],
  pages: [
    { path: '/volumes', show: () => <VolumesPage /> },
    { path: '/volumes/:id', show: (at) => <VolumePage key={at('id')} id={at('id')} /> },
  ],
};
