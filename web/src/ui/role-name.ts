import { marked, say } from '@/language';
import type { Role } from './feature';

const kRoles: Readonly<Record<Role, string>> = {
  admin: marked('admin'),
  director: marked('director'),
  faculty: marked('faculty'),
  researcher: marked('researcher'),
  technician: marked('technician'),
  trainee: marked('trainee'),
};

/** A role of the server's as a word of the page. */
export const roleName = (role: string): string => say(kRoles[role as Role] ?? role);
