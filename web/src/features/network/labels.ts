import type { Role } from '@/api';
import type { Tone } from '@/ui';
import { formatDateTime, type UtcMicroseconds } from '@/units';

export const kRoleLabels: Record<Role, { name: string; description: string }> = {
  trainee: {
    name: 'Trainee',
    description: 'Does assigned trials at a station and sees their own progress after the results are released.',
  },
  faculty: {
    name: 'Faculty',
    description: 'Leads cohorts: assigns trials to their members, supervises and debriefs them.',
  },
  director: { name: 'Programme director', description: 'Sees all trainees and their progress.' },
  researcher: { name: 'Researcher', description: 'Works with studies, analyses and the model lab.' },
  technician: { name: 'Technician', description: 'Enrols and maintains stations.' },
  admin: { name: 'Administrator', description: 'Has full access, including accounts and the audit trail.' },
};

export const roleName = (role: string) => (role in kRoleLabels ? kRoleLabels[role as Role].name : role);

const kDay_us = 86_400_000_000;
const kSoon_days = 14;

/** Is a calibration due? `now` in microseconds. */
export function calibrationLabel(due: UtcMicroseconds | null, now: number): { tone: Tone; text: string } {
  if (due === null) return { tone: 'neutral', text: 'not reported yet' };
  const days = Math.floor((due - now) / kDay_us);
  if (days < 0) return { tone: 'bad', text: `overdue since ${formatDateTime(due)}` };
  return days <= kSoon_days
    ? { tone: 'warn', text: `due in ${days} ${days === 1 ? 'day' : 'days'}` }
    : { tone: 'good', text: `due ${formatDateTime(due)}` };
}
