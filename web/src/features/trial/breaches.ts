/** Moments at which the controller entered soft tissue, from the modes that it recorded. */
import type { ForceDepth } from '@/api';
import type { Mark } from '@/charts';

export function breachMarks(curve: ForceDepth | undefined): Mark[] {
  if (!curve) return [];
  const marks: Mark[] = [];
  curve.mode.forEach((mode, i) => {
    if (mode === 'breach' && curve.mode[i - 1] !== 'breach') marks.push({ t_s: curve.t_s[i] ?? 0, label: 'breach' });
  });
  return marks;
}
