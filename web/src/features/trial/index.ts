export { TrialPage as default } from './trial-page';
