/**
 * Moments at which a wall gave way, from the modes that the controller recorded: the probe enters soft tissue deeper than it has
 * ever been. Coming back into it from the bone behind is no breach.
 */
import type { ForceDepth } from '@/api';
import type { Mark } from '@/charts';
import { say } from '@/language';

export function breachMarks(curve: ForceDepth | undefined): Mark[] {
  if (!curve) return [];
  const marks: Mark[] = [];
  let deepest_m = -Infinity;
  curve.mode.forEach((mode, i) => {
    const depth_m = curve.depth_m[i] ?? 0;
    if (mode === 'breach' && curve.mode[i - 1] !== 'breach' && depth_m >= deepest_m)
      marks.push({ t_s: curve.t_s[i] ?? 0, label: say('breach') });
    deepest_m = Math.max(deepest_m, depth_m);
  });
  return marks;
}
