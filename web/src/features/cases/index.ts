export { CasePage } from './case-page';
export { CasesPage } from './cases-page';
export { NewCasePage } from './new-case-page';
