/** The page of one trial. */
import { lazy } from 'react';
import type { Feature } from '@/ui';

const TrialPage = lazy(() => import('./index'));

export const feature: Feature = {
  menu: [],
  pages: [{ path: '/trials/:id', show: (at) => <TrialPage key={at('id')} id={at('id')} /> }],
};
