/** The list of trials. */
import { marked } from '@/language';
import type { Feature } from '@/ui';
import { TrialsPage } from './trials-page';

export const feature: Feature = {
  menu: [{ to: '/trials', name: marked('Trials'), roles: ['admin', 'director', 'faculty', 'trainee'], order: 20 }],
  pages: [{ path: '/trials', show: () => <TrialsPage /> }],
};
