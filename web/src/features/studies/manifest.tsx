/** The list of studies, and a new one. */
import { lazy } from 'react';
import { marked } from '@/language';
import type { Feature } from '@/ui';
import { StudiesPage } from './studies-page';

const NewStudyPage = lazy(() => import('./new-study-page').then(({ NewStudyPage: page }) => ({ default: page })));

export const feature: Feature = {
  menu: [{ to: '/studies', name: marked('Studies'), roles: ['admin', 'researcher'], order: 80 }],
  pages: [
    { path: '/studies', show: () => <StudiesPage /> },
    { path: '/studies/new', show: () => <NewStudyPage /> },
  ],
};
