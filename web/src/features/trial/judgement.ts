/** Answer against truth, in plain words. The rule is that of the metric answer_right. */
import type { Answer, Truth } from '@/api';
import { formatShare } from '@/units';

export interface Judgement {
  readonly outcome: 'right' | 'wrong' | 'open';
  readonly headline: string;
  readonly said: string;
  readonly truth: string;
}

function saidOf(answer: Answer | null): string {
  if (!answer) return 'No answer was given.';
  const sure = answer.confidence === null ? '' : ` Confidence ${formatShare(answer.confidence)}.`;
  if (!answer.breach) return `No breach.${sure}`;
  return `${answer.wall === null ? 'A breach, no wall named.' : `A breach of the ${answer.wall} wall.`}${sure}`;
}

function truthOf(truth: Truth | null): string {
  if (!truth) return 'Not released for this trial.';
  return truth.breached === null ? 'The tract is intact.' : `The ${truth.breached} wall is breached.`;
}

export function judge(answer: Answer | null, truth: Truth | null): Judgement {
  const words = { said: saidOf(answer), truth: truthOf(truth) };
  if (!answer) return { outcome: 'open', headline: 'No answer', ...words };
  if (!truth) return { outcome: 'open', headline: 'Not judged yet', ...words };
  if (answer.breach !== (truth.breached !== null)) {
    return { outcome: 'wrong', headline: answer.breach ? 'Wrong: a breach was named where there is none' : 'Wrong: the breach was missed', ...words };
  }
  if (truth.breached !== null && answer.wall !== truth.breached) {
    return { outcome: 'wrong', headline: answer.wall === null ? 'Wrong: a breach was felt, but no wall was named' : 'Wrong: a breach was felt, but in another wall', ...words };
  }
  return { outcome: 'right', headline: 'Right', ...words };
}
