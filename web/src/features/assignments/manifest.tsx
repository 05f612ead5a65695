/** Pages of assignments: what trainees are to do. */
import { lazy } from 'react';
import { marked } from '@/language';
import type { Feature } from '@/ui';

const index = () => import('./index');
const AssignmentPage = lazy(() => index().then(({ AssignmentPage: page }) => ({ default: page })));
const AssignmentsPage = lazy(() => index().then(({ AssignmentsPage: page }) => ({ default: page })));
const NewAssignmentPage = lazy(() => index().then(({ NewAssignmentPage: page }) => ({ default: page })));

export const feature: Feature = {
  menu: [
    { to: '/assignments', name: marked('My work'), roles: ['trainee'], order: 10 },
    { to: '/assignments', name: marked('Assignments'), roles: ['admin', 'director', 'faculty'], order: 50 },
  ],
  pages: [
    { path: '/assignments', show: () => <AssignmentsPage /> },
    { path: '/assignments/new', show: () => <NewAssignmentPage /> },
    { path: '/assignments/:id', show: (at) => <AssignmentPage key={at('id')} id={at('id')} /> },
  ],
};
