/** The verdict of a diagnosis: a headline, and a sentence with the figures. */
import type { Diagnosis } from '@/api';
import { formatFigure, formatShare, share } from '@/units';
import { effectName, joined } from './names';

export interface Verdict {
  readonly tone: 'good' | 'warn' | 'bad' | 'accent';
  readonly headline: string;
  readonly detail: string;
}

export function verdictOf(diagnosis: Diagnosis, unit: string): Verdict {
  const { verdict, base, effects, steps, probability } = diagnosis;
  const floor = formatFigure(base.noise_floor, unit),
    was = formatFigure(base.held_out_rmse ?? base.rmse, unit);
  const last = steps.at(-1),
    now = formatFigure(last?.held_out_rmse ?? last?.rmse, unit);
  const found = joined(effects.map(({ id }) => effectName(id)));
  const are = effects.length > 1 ? 'are' : 'is';
  const certainty = probability === null ? '' : ` Probability of this answer: ${formatShare(share(probability))}.`;
  const decrease = `On held-out trials the error decreases from ${was} to ${now}; the noise floor is ${floor}.`;
  switch (verdict) {
    case 'complete':
      return {
        tone: 'good',
        headline: 'No effect is missing.',
        detail: `The error of the model, ${was}, is at the noise floor, ${floor}. No effect was added.${certainty}`,
      };
    case 'missing':
      return {
        tone: 'accent',
        headline: `${found} ${are} missing.`,
        detail: `${decrease} This explains the remaining error.${certainty}`,
      };
    case 'partly':
      return {
        tone: 'warn',
        headline: `${found} ${are} missing, and at least one other effect.`,
        detail: `${decrease} The remaining error is larger than noise${diagnosis.depends_on === '' ? '' : `; it varies with ${diagnosis.depends_on}`}.${certainty}`,
      };
    case 'unexplained':
      return {
        tone: 'bad',
        headline: 'A missing effect is not in the catalogue.',
        detail: `The error of the model is ${was}, the noise floor ${floor}, and no effect of the catalogue explains the difference${diagnosis.depends_on === '' ? '' : `. It varies with ${diagnosis.depends_on}`}. Try a custom formula under “Add effects”.${certainty}`,
      };
  }
}
