/** Pages of ratings by people: what is to be rated, rubrics, how far raters agree. A trial is rated in its debriefing. */
import { lazy } from 'react';
import { marked } from '@/language';
import type { Feature } from '@/ui';

const index = () => import('./index');
const AgreementPage = lazy(() => index().then(({ AgreementPage: page }) => ({ default: page })));
const RatingsPage = lazy(() => index().then(({ RatingsPage: page }) => ({ default: page })));
const RubricEditor = lazy(() => index().then(({ RubricEditor: page }) => ({ default: page })));
const RubricsPage = lazy(() => index().then(({ RubricsPage: page }) => ({ default: page })));

export const feature: Feature = {
  menu: [{ to: '/ratings', name: marked('Ratings'), roles: ['director', 'faculty'], order: 57 }],
  pages: [
    { path: '/ratings', show: () => <RatingsPage /> },
    { path: '/ratings/agreement', show: () => <AgreementPage /> },
    { path: '/ratings/rubrics', show: () => <RubricsPage /> },
    { path: '/ratings/rubrics/new', show: () => <RubricEditor /> },
    { path: '/ratings/rubrics/:id', show: (at) => <RubricEditor key={at('id')} id={at('id')} /> },
  ],
};
