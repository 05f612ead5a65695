export { StudyPage } from './study-page';
