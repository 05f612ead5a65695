export { ChangePage } from './change-page';
export { GroupsPage } from './groups-page';
export { ImportPage } from './import-page';
