import type { kKinds } from '@/api';
import { marked, say } from '@/language';

const kKindLabels: Record<(typeof kKinds)[number], string> = {
  hard: marked('hard bone, no breach'),
  soft: marked('soft bone, no breach'),
  lateral_breach: marked('lateral breach'),
  in_out_in: marked('in, out and in again'),
};

export const kindLabel = (kind: (typeof kKinds)[number]): string => say(kKindLabels[kind]);
