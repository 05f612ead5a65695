/** The account of the person who is signed in. */
import type { Feature } from '@/ui';
import { OwnAccountPage } from './own-account-page';

export const feature: Feature = {
  menu: [],
  pages: [{ path: '/account', show: () => <OwnAccountPage /> }],
};
