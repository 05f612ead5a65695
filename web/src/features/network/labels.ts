import type { Role } from '@/api';
import { marked, say } from '@/language';
import type { Tone } from '@/ui';
import { formatDateTime, type UtcMicroseconds } from '@/units';

export const kRoleLabels: Record<Role, { name: string; description: string }> = {
  trainee: {
    name: marked('Trainee'),
    description: marked(
      'Does assigned trials at a station and sees their own progress after the results are released.',
    ),
  },
  faculty: {
    name: marked('Faculty'),
    description: marked('Leads cohorts: assigns trials to their members, supervises and debriefs them.'),
  },
  director: { name: marked('Programme director'), description: marked('Sees all trainees and their progress.') },
  researcher: { name: marked('Researcher'), description: marked('Works with studies, analyses and the model lab.') },
  technician: { name: marked('Technician'), description: marked('Enrols and maintains stations.') },
  admin: {
    name: marked('Administrator'),
    description: marked('Has full access, including accounts and the audit trail.'),
  },
};

export const roleName = (role: string) => (role in kRoleLabels ? kRoleLabels[role as Role].name : role);

const kDay_us = 86_400_000_000;
const kSoon_days = 14;

/** Is a calibration due? `now` in microseconds. */
export function calibrationLabel(due: UtcMicroseconds | null, now: number): { tone: Tone; text: string } {
  if (due === null) return { tone: 'neutral', text: say('not reported yet') };
  const days = Math.floor((due - now) / kDay_us);
  if (days < 0) return { tone: 'bad', text: say('overdue since {time}', { time: formatDateTime(due) }) };
  return days <= kSoon_days
    ? { tone: 'warn', text: say('due in {days, plural, one {# day} other {# days}}', { days }) }
    : { tone: 'good', text: say('due {time}', { time: formatDateTime(due) }) };
}
