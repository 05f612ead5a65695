export { AssignmentPage } from './assignment-page';
export { AssignmentsPage } from './assignments-page';
export { NewAssignmentPage } from './new-assignment-page';
