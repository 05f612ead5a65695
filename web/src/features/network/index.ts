export { AuditPage } from './audit-page';
export { CohortsPage } from './cohorts-page';
export { PeoplePage } from './people-page';
export { StationsPage } from './stations-page';
export { BackupsPage } from './backups-page';
export { StationPage } from './station-page';
