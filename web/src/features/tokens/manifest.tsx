/** API tokens: a person's own, and an administrator's list of all. */
import { lazy } from 'react';
import type { Feature } from '@/ui';

const index = () => import('./index');
const AllTokensPage = lazy(() => index().then(({ AllTokensPage: page }) => ({ default: page })));
const OwnTokensPage = lazy(() => index().then(({ OwnTokensPage: page }) => ({ default: page })));

export const feature: Feature = {
  menu: [],
  pages: [
    { path: '/account/tokens', show: () => <OwnTokensPage /> },
    { path: '/network/tokens', show: () => <AllTokensPage /> },
  ],
};
