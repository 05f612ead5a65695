/** Pages of scenarios of the probing rig. */
import { lazy } from 'react';
import { marked } from '@/language';
import type { Feature } from '@/ui';

const index = () => import('./index');
const ScenarioPage = lazy(() => index().then(({ ScenarioPage: page }) => ({ default: page })));
const ScenariosPage = lazy(() => index().then(({ ScenariosPage: page }) => ({ default: page })));

export const feature: Feature = {
  menu: [{ to: '/scenarios', name: marked('Scenarios'), roles: ['admin', 'faculty'], order: 40 }],
  pages: [
    { path: '/scenarios', show: () => <ScenariosPage /> },
    { path: '/scenarios/:id', show: (at) => <ScenarioPage key={at('id')} id={at('id')} /> },
  ],
};
