/** The verdict of a diagnosis in the server's words, and how it is shown. */
import type { Diagnosis, LabRun } from '@/api';
import { marked, say } from '@/language';
import { formatShare, share } from '@/units';

export interface Verdict {
  readonly tone: 'good' | 'warn' | 'bad' | 'accent';
  readonly headline: string;
  readonly detail: string;
}

const kTones = { complete: 'good', missing: 'accent', partly: 'warn', unexplained: 'bad', undecided: 'warn' } as const;
/** Of results from before the server wrote sentences. */
const kHeadlines = {
  complete: marked('No effect is missing.'),
  missing: marked('An effect is missing.'),
  partly: marked('Effects are missing; those found explain a part.'),
  unexplained: marked('A missing effect is not in the catalogue.'),
  undecided: marked('These recordings cannot tell whether an effect is missing.'),
};

export function verdictOf({ verdict, headline, detail, probability }: Diagnosis): Verdict {
  const certainty =
    probability === null ? '' : say('Probability of this answer: {share}.', { share: formatShare(share(probability)) });
  return {
    tone: kTones[verdict],
    headline: headline || say(kHeadlines[verdict]),
    detail: [detail, certainty].filter(Boolean).join(' '),
  };
}

/** Whether a run's model has no smaller error on held-out trials than the model that it came from; unknown is not worse. */
export function isNotBetter({ fit, diagnosis }: Pick<LabRun, 'fit' | 'diagnosis'>): boolean {
  const before = fit ? fit.base.rmse : diagnosis?.base.held_out_rmse,
    after = fit ? fit.held_out_rmse : diagnosis?.steps.at(-1)?.held_out_rmse;
  return typeof before === 'number' && typeof after === 'number' && after >= before;
}
