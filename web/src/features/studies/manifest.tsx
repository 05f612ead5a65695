/** The list of studies, and a new one. */
import { lazy } from 'react';
import { marked } from '@/language';
import type { Feature } from '@/ui';

const index = () => import('./index');
const NewStudyPage = lazy(() => index().then(({ NewStudyPage: page }) => ({ default: page })));
const StudiesPage = lazy(() => index().then(({ StudiesPage: page }) => ({ default: page })));

export const feature: Feature = {
  menu: [{ to: '/studies', name: marked('Studies'), roles: ['admin', 'researcher'], order: 80 }],
  pages: [
    { path: '/studies', show: () => <StudiesPage /> },
    { path: '/studies/new', show: () => <NewStudyPage /> },
  ],
};
