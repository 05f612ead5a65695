/** The list of trials. */
import type { Feature } from '@/ui';
import { TrialsPage } from './trials-page';

export const feature: Feature = {
  menu: [{ to: '/trials', name: 'Trials', roles: ['admin', 'director', 'faculty', 'trainee'], order: 20 }],
  pages: [{ path: '/trials', show: () => <TrialsPage /> }],
};
