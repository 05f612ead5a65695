/** The page on which all stations are watched live. */
import { lazy } from 'react';
import type { Feature } from '@/ui';

const index = () => import('./index');
const WallPage = lazy(() => index().then(({ WallPage: page }) => ({ default: page })));

export const feature: Feature = {
  menu: [
    { to: '/wall', name: 'Live', roles: ['admin', 'director', 'faculty', 'technician'], order: 110 },
  ],
  pages: [
    { path: '/wall', show: () => <WallPage /> },
  ],
};
