export { AnalysisPage } from './analysis-page';
export { NewPlanPage, PlanPage } from './plan-pages';
export { ExamplePage, RunPage } from './run-page';
