export { AuditPage } from './audit-page';
export { CohortsPage } from './cohorts-page';
export { LeavingPage } from './leaving-page';
export { PeoplePage } from './people-page';
export { StationsPage } from './stations-page';
export { BackupsPage } from './backups-page';
export { RetentionPage } from './retention-page';
export { StationPage } from './station-page';
