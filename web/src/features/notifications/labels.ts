import type { NotificationKind } from '@/api';

/** Events in words. */
export const kKindNames: Readonly<Record<NotificationKind, string>> = {
  due: 'Assignment due',
  overdue: 'Assignment overdue',
  released: 'Results released',
  relapse: 'Relapse signalled',
  self_test_failed: 'Station failed its self-test',
  backup_failed: 'Backup failed',
  test: 'Test',
};
