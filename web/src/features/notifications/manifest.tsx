/** Notifications: a person's own choices, and an administrator's view of mail and webhooks. */
import { lazy } from 'react';
import type { Feature } from '@/ui';

const index = () => import('./index');
const MailPage = lazy(() => index().then(({ MailPage: page }) => ({ default: page })));
const OwnNotificationsPage = lazy(() => index().then(({ OwnNotificationsPage: page }) => ({ default: page })));

export const feature: Feature = {
  menu: [],
  pages: [
    { path: '/account/notifications', show: () => <OwnNotificationsPage /> },
    { path: '/network/mail', show: () => <MailPage /> },
  ],
};
