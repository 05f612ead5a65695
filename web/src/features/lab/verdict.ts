/** A diagnosis in plain words: a headline, and a sentence with the figures behind it. */
import type { Diagnosis } from '@/api';
import { formatFigure, formatShare, share } from '@/units';
import { effectName, joined } from './words';

export interface Verdict { readonly tone: 'good' | 'warn' | 'bad' | 'accent'; readonly headline: string; readonly detail: string }

export function verdictOf(diagnosis: Diagnosis, unit: string): Verdict {
  const { verdict, base, effects, steps, probability } = diagnosis;
  const floor = formatFigure(base.noise_floor, unit), was = formatFigure(base.held_out_rmse ?? base.rmse, unit);
  const last = steps.at(-1), now = formatFigure(last?.held_out_rmse ?? last?.rmse, unit);
  const found = joined(effects.map(({ id }) => effectName(id)));
  const are = effects.length > 1 ? 'are' : 'is';
  const sure = probability === null ? '' : ` Probability of this answer: ${formatShare(share(probability))}.`;
  const fall = `On trials that the fit did not see the error falls from ${was} to ${now}; noise alone leaves ${floor}.`;
  switch (verdict) {
    case 'complete': return { tone: 'good', headline: 'Nothing is missing.', detail: `The model is at the noise floor: it leaves ${was}, and noise alone leaves ${floor}. Nothing was added.${sure}` };
    case 'missing': return { tone: 'accent', headline: `${found} ${are} missing.`, detail: `${fall} That explains the rest.${sure}` };
    case 'partly': return { tone: 'warn', headline: `${found} ${are} missing, and something more.`, detail: `${fall} What is still left is more than noise${diagnosis.depends_on === '' ? '' : `; it varies with ${diagnosis.depends_on}`}.${sure}` };
    case 'unexplained': return { tone: 'bad', headline: 'Something is missing that is not in the catalogue.', detail: `The model leaves ${was}, noise alone ${floor}, and no known effect explains the rest${diagnosis.depends_on === '' ? '' : `. It varies with ${diagnosis.depends_on}`}. Try a formula of your own under “Add”.${sure}` };
  }
}
