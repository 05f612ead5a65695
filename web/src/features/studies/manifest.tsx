/** The list of studies, and a new one. */
import type { Feature } from '@/ui';
import { NewStudyPage } from './new-study-page';
import { StudiesPage } from './studies-page';

export const feature: Feature = {
  menu: [{ to: '/studies', name: 'Studies', roles: ['admin', 'researcher'], order: 80 }],
  pages: [
    { path: '/studies', show: () => <StudiesPage /> },
    { path: '/studies/new', show: () => <NewStudyPage /> },
  ],
};
