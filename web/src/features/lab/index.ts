export { LabPage } from './lab-page';
export { VersionsPage } from './versions-page';
export { WorkPage } from './work-page';
