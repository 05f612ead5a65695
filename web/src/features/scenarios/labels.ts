import type { kKinds } from '@/api';

export const kKindLabels: Record<(typeof kKinds)[number], string> = {
  hard: 'hard bone, no breach',
  soft: 'soft bone, no breach',
  lateral_breach: 'lateral breach',
  in_out_in: 'in, out and in again',
};
