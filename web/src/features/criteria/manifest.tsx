/** Pages of what passing is: criteria, curricula, who has passed, certificates. */
import { lazy } from 'react';
import { marked } from '@/language';
import type { Feature } from '@/ui';

const index = () => import('./index');
const CertificatePage = lazy(() => index().then(({ CertificatePage: page }) => ({ default: page })));
const CriteriaPage = lazy(() => index().then(({ CriteriaPage: page }) => ({ default: page })));
const CurriculaPage = lazy(() => index().then(({ CurriculaPage: page }) => ({ default: page })));
const CurriculumEditor = lazy(() => index().then(({ CurriculumEditor: page }) => ({ default: page })));
const CurriculumPage = lazy(() => index().then(({ CurriculumPage: page }) => ({ default: page })));
const OwnCurriculaPage = lazy(() => index().then(({ OwnCurriculaPage: page }) => ({ default: page })));
const PassingPage = lazy(() => index().then(({ PassingPage: page }) => ({ default: page })));

export const feature: Feature = {
  menu: [
    { to: '/curricula', name: marked('Curricula'), roles: ['director', 'faculty'], order: 55 },
    { to: '/curriculum', name: marked('My curriculum'), roles: ['trainee'], order: 15 },
  ],
  pages: [
    { path: '/criteria', show: () => <CriteriaPage /> },
    {
      path: '/criteria/:kind/:id',
      show: (at) => <PassingPage key={at('id')} kind={at('kind') === 'case' ? 'case' : 'assignment'} id={at('id')} />,
    },
    { path: '/curricula', show: () => <CurriculaPage /> },
    { path: '/curricula/new', show: () => <CurriculumEditor /> },
    { path: '/curricula/:id', show: (at) => <CurriculumPage key={at('id')} id={at('id')} /> },
    { path: '/curricula/:id/edit', show: (at) => <CurriculumEditor key={at('id')} id={at('id')} /> },
    { path: '/curriculum', show: () => <OwnCurriculaPage /> },
    {
      path: '/certificates/:account/:curriculum',
      show: (at) => <CertificatePage account={at('account')} curriculum={at('curriculum')} />,
    },
  ],
};
