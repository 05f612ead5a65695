export { ChangePage } from './change-page';
export { ImportPage } from './import-page';
