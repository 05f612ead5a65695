import type { Role } from '@/api';
import type { Tone } from '@/ui';
import { formatDateTime, type UtcMicroseconds } from '@/units';

export const kRoleWords: Record<Role, { name: string; may: string }> = {
  trainee: { name: 'Trainee', may: 'Does the assigned trials at a station, sees the own curve once results are released.' },
  faculty: { name: 'Faculty', may: 'Leads cohorts: assigns, watches, debriefs the people in them.' },
  director: { name: 'Programme director', may: 'Sees every trainee, and who is on track.' },
  researcher: { name: 'Researcher', may: 'Works with studies, analyses and the model lab.' },
  technician: { name: 'Technician', may: 'Enrols stations and looks after them.' },
  admin: { name: 'Administrator', may: 'All of it, accounts and the audit trail too.' },
};

export const roleName = (role: string) => (role in kRoleWords ? kRoleWords[role as Role].name : role);

const kDay_us = 86_400_000_000;
const kSoon_days = 14;

/** Is a calibration due? `now` in microseconds. */
export function calibrationWords(due: UtcMicroseconds | null, now: number): { tone: Tone; words: string } {
  if (due === null) return { tone: 'neutral', words: 'not told yet' };
  const days = Math.floor((due - now) / kDay_us);
  if (days < 0) return { tone: 'bad', words: `overdue since ${formatDateTime(due)}` };
  return days <= kSoon_days ? { tone: 'warn', words: `due in ${days} ${days === 1 ? 'day' : 'days'}` } : { tone: 'good', words: `due ${formatDateTime(due)}` };
}
