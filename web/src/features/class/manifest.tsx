/** Pages of a class: many accounts at once. */
import { lazy } from 'react';
import { marked } from '@/language';
import type { Feature } from '@/ui';

const index = () => import('./index');
const ChangePage = lazy(() => index().then(({ ChangePage: page }) => ({ default: page })));
const GroupsPage = lazy(() => index().then(({ GroupsPage: page }) => ({ default: page })));
const ImportPage = lazy(() => index().then(({ ImportPage: page }) => ({ default: page })));

export const feature: Feature = {
  // An administrator's menu is long: there it is linked from the accounts.
  menu: [{ to: '/class', name: marked('Class'), roles: ['director'], order: 58 }],
  pages: [
    { path: '/class', show: () => <ImportPage /> },
    { path: '/class/change', show: () => <ChangePage /> },
    { path: '/class/groups', show: () => <GroupsPage /> },
  ],
};
