/** Pages of cases and of volumes to make them from. */
import { lazy } from 'react';
import { marked } from '@/language';
import type { Feature } from '@/ui';

const index = () => import('./index');
const CasePage = lazy(() => index().then(({ CasePage: page }) => ({ default: page })));
const CasesPage = lazy(() => index().then(({ CasesPage: page }) => ({ default: page })));
const NewCasePage = lazy(() => index().then(({ NewCasePage: page }) => ({ default: page })));

export const feature: Feature = {
  menu: [{ to: '/cases', name: marked('Cases'), roles: ['admin', 'director', 'faculty', 'researcher'], order: 30 }],
  pages: [
    { path: '/cases', show: () => <CasesPage /> },
    { path: '/cases/new/:volume', show: (at) => <NewCasePage key={at('volume')} volume={at('volume')} /> },
    { path: '/cases/:id', show: (at) => <CasePage key={at('id')} id={at('id')} /> },
  ],
};
