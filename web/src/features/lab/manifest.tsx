/** Pages of the model lab. */
import { lazy } from 'react';
import { marked } from '@/language';
import type { Feature } from '@/ui';

const index = () => import('./index');
const LabPage = lazy(() => index().then(({ LabPage: page }) => ({ default: page })));
const VersionsPage = lazy(() => index().then(({ VersionsPage: page }) => ({ default: page })));
const WorkPage = lazy(() => index().then(({ WorkPage: page }) => ({ default: page })));

export const feature: Feature = {
  menu: [{ to: '/lab', name: marked('Model lab'), roles: ['admin', 'researcher'], order: 100 }],
  pages: [
    { path: '/lab', show: () => <LabPage /> },
    { path: '/lab/versions', show: () => <VersionsPage /> },
    {
      path: '/lab/work/:model/:set/:step?',
      show: (at) => (
        <WorkPage
          key={`${at('model')} ${at('set')}`}
          model={at('model')}
          set={at('set')}
          step={at('step') || 'compare'}
        />
      ),
    },
  ],
};
