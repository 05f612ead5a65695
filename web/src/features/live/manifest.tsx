/** The live view of all stations. */
import { lazy } from 'react';
import { marked } from '@/language';
import type { Feature } from '@/ui';

const index = () => import('./index');
const LivePage = lazy(() => index().then(({ LivePage: page }) => ({ default: page })));

export const feature: Feature = {
  menu: [{ to: '/wall', name: marked('Live'), roles: ['admin', 'director', 'faculty', 'technician'], order: 110 }],
  pages: [{ path: '/wall', show: () => <LivePage /> }],
};
