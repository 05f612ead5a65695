export { VolumePage } from './volume-page';
export { VolumesPage } from './volumes-page';
