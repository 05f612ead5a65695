/** Pages of a class: many accounts at once. */
import { lazy } from 'react';
import type { Feature } from '@/ui';

const index = () => import('./index');
const ChangePage = lazy(() => index().then(({ ChangePage: page }) => ({ default: page })));
const GroupsPage = lazy(() => index().then(({ GroupsPage: page }) => ({ default: page })));
const ImportPage = lazy(() => index().then(({ ImportPage: page }) => ({ default: page })));

export const feature: Feature = {
  menu: [], // linked from the accounts: an administrator's menu is long
  pages: [
    { path: '/class', show: () => <ImportPage /> },
    { path: '/class/change', show: () => <ChangePage /> },
    { path: '/class/groups', show: () => <GroupsPage /> },
  ],
};
