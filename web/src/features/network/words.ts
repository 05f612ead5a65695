import type { Role } from '@/api';

export const kRoleWords: Record<Role, { name: string; may: string }> = {
  trainee: { name: 'Trainee', may: 'Does the assigned trials at a station, sees the own curve once results are released.' },
  faculty: { name: 'Faculty', may: 'Leads cohorts: assigns, watches, debriefs the people in them.' },
  director: { name: 'Programme director', may: 'Sees every trainee, and who is on track.' },
  researcher: { name: 'Researcher', may: 'Works with studies, analyses and the model lab.' },
  technician: { name: 'Technician', may: 'Enrols stations and looks after them.' },
  admin: { name: 'Administrator', may: 'All of it, accounts and the audit trail too.' },
};

export const roleName = (role: string) => (role in kRoleWords ? kRoleWords[role as Role].name : role);
