export { NewStudyPage } from './new-study-page';
export { StudiesPage } from './studies-page';
