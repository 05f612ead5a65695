export { TrialsPage } from './trials-page';
