/** Answer against truth, in plain words. The rule is that of the metric answer_right. */
import type { Answer, Scenario, Truth } from '@/api';
import { formatLength, formatShare } from '@/units';

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

function feltOf(answer: Answer | null): string {
  if (!answer) return 'No answer was given.';
  const sure = answer.confidence === null ? '' : ` Confidence ${formatShare(answer.confidence)}.`;
  if (!answer.breach) return `No breach.${sure}`;
  return `A breach${answer.depth_m === null ? ', no depth named' : ` at ${formatLength(answer.depth_m)}`}.${sure}`;
}

function bonesOf(scenario: Scenario | null): string {
  if (!scenario) return 'Not released for this trial.';
  const [wall] = scenario.walls;
  if (!wall) return `${scenario.name}: nothing is breached.`;
  return `${scenario.name}: the wall gives way at ${scenario.walls.map(({ position_m }) => formatLength(position_m)).join(' and ')}.`;
}

/** Probing: was a breach felt where there is one? Where it was felt is told beside, and not judged. */
export function judgeProbing(answer: Answer | null, scenario: Scenario | null): Judgement {
  const words = { said: feltOf(answer), truth: bonesOf(scenario) };
  if (!answer) return { outcome: 'open', headline: 'No answer', ...words };
  if (!scenario) return { outcome: 'open', headline: 'Not judged yet', ...words };
  const there = scenario.walls.length > 0;
  if (answer.breach === there) return { outcome: 'right', headline: 'Right', ...words };
  return { outcome: 'wrong', headline: there ? 'Wrong: the breach was missed' : 'Wrong: a breach was felt where there is none', ...words };
}
