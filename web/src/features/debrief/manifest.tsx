/** The debriefing of a trial. */
import { lazy } from 'react';
import type { Feature } from '@/ui';

const index = () => import('./index');
const DebriefPage = lazy(() => index().then(({ DebriefPage: page }) => ({ default: page })));

export const feature: Feature = {
  menu: [],
  pages: [{ path: '/trials/:id/debrief', show: (at) => <DebriefPage key={at('id')} id={at('id')} /> }],
};
