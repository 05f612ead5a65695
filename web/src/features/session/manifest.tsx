/** The account of the person who is signed in. */
import { lazy } from 'react';
import type { Feature } from '@/ui';

const OwnAccountPage = lazy(() => import('./own-account-page').then(({ OwnAccountPage: page }) => ({ default: page })));

export const feature: Feature = {
  menu: [],
  pages: [{ path: '/account', show: () => <OwnAccountPage /> }],
};
