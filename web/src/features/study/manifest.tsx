/** The page of one study. */
import { lazy } from 'react';
import type { Feature } from '@/ui';

const StudyPage = lazy(() => import('./index').then(({ StudyPage: page }) => ({ default: page })));

export const feature: Feature = {
  menu: [],
  pages: [{ path: '/studies/:id', show: (at) => <StudyPage key={at('id')} id={at('id')} /> }],
};
