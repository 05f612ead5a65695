export { ScenarioPage } from './scenario-page';
export { ScenariosPage } from './scenarios-page';
