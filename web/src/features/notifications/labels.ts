import type { NotificationKind } from '@/api';
import { marked } from '@/language';

/** Events in words, to be shown through `say`. */
export const kKindNames: Readonly<Record<NotificationKind, string>> = {
  due: marked('Assignment due'),
  overdue: marked('Assignment overdue'),
  released: marked('Results released'),
  relapse: marked('Relapse signalled'),
  self_test_failed: marked('Station failed its self-test'),
  backup_failed: marked('Backup failed'),
  test: marked('Test'),
};
