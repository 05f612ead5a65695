export { CohortsPage } from './cohorts-page';
export { TraineePage } from './trainee-page';
export { TraineesPage } from './trainees-page';
