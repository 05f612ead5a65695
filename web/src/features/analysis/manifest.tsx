/** Pages of analyses and their locked plans. */
import { lazy } from 'react';
import { marked } from '@/language';
import type { Feature } from '@/ui';

const index = () => import('./index');
const AnalysisPage = lazy(() => index().then(({ AnalysisPage: page }) => ({ default: page })));
const ExamplePage = lazy(() => index().then(({ ExamplePage: page }) => ({ default: page })));
const NewPlanPage = lazy(() => index().then(({ NewPlanPage: page }) => ({ default: page })));
const PlanPage = lazy(() => index().then(({ PlanPage: page }) => ({ default: page })));
const RunPage = lazy(() => index().then(({ RunPage: page }) => ({ default: page })));

export const feature: Feature = {
  menu: [{ to: '/analysis', name: marked('Analysis'), roles: ['admin', 'director', 'researcher'], order: 90 }],
  pages: [
    { path: '/analysis', show: () => <AnalysisPage /> },
    { path: '/analysis/example', show: () => <ExamplePage /> },
    { path: '/analysis/plans/new', show: () => <NewPlanPage /> },
    { path: '/analysis/plans/:id', show: (at) => <PlanPage key={at('id')} id={at('id')} /> },
    { path: '/analysis/runs/:id', show: (at) => <RunPage key={at('id')} id={at('id')} /> },
  ],
};
