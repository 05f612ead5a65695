/** The guide, a page for each role. */
import { lazy } from 'react';
import { marked } from '@/language';
import type { Feature } from '@/ui';

const index = () => import('./index');
const GuidePage = lazy(() => index().then(({ GuidePage: page }) => ({ default: page })));

export const feature: Feature = {
  menu: [
    {
      to: '/guide',
      name: marked('Guide'),
      roles: ['admin', 'director', 'faculty', 'researcher', 'technician', 'trainee'],
      order: 130,
    },
  ],
  pages: [{ path: '/guide/:role?', show: (at) => <GuidePage role={at('role') || undefined} /> }],
};
