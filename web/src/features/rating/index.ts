export { AgreementPage } from './agreement-page';
export { RatingsPage } from './ratings-page';
export { RubricEditor } from './rubric-editor';
export { RubricsPage } from './rubrics-page';
