export { MailPage } from './mail-page';
export { OwnNotificationsPage } from './own-page';
