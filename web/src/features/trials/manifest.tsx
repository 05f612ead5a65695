/** The list of trials. */
import { lazy } from 'react';
import { marked } from '@/language';
import type { Feature } from '@/ui';

const TrialsPage = lazy(() => import('./index').then(({ TrialsPage: page }) => ({ default: page })));

export const feature: Feature = {
  menu: [{ to: '/trials', name: marked('Trials'), roles: ['admin', 'director', 'faculty', 'trainee'], order: 20 }],
  pages: [{ path: '/trials', show: () => <TrialsPage /> }],
};
