export { CertificatePage } from './certificate-page';
export { CriteriaPage } from './criteria-page';
export { CurriculaPage } from './curricula-page';
export { CurriculumEditor } from './curriculum-editor';
export { CurriculumPage } from './curriculum-page';
export { OwnCurriculaPage } from './own-page';
export { PassingPage } from './passing-page';
