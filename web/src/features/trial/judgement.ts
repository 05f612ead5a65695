/** Compares the answer with the truth, by the rule of the metric answer_right. */
import type { Answer, Scenario, Truth } from '@/api';
import { formatLength, formatShare } from '@/units';

export interface Judgement {
  readonly outcome: 'correct' | 'incorrect' | 'open';
  readonly headline: string;
  readonly given: string;
  readonly truth: string;
}

function palpationAnswerText(answer: Answer | null): string {
  if (!answer) return 'No answer was given.';
  const confidence = answer.confidence === null ? '' : ` Confidence ${formatShare(answer.confidence)}.`;
  if (!answer.breach) return `No breach.${confidence}`;
  return `${answer.wall === null ? 'A breach, no wall named.' : `A breach of the ${answer.wall} wall.`}${confidence}`;
}

function truthText(truth: Truth | null): string {
  if (!truth) return 'Not released for this trial.';
  return truth.breached === null ? 'The tract is intact.' : `The ${truth.breached} wall is breached.`;
}

export function judge(answer: Answer | null, truth: Truth | null): Judgement {
  const texts = { given: palpationAnswerText(answer), truth: truthText(truth) };
  if (!answer) return { outcome: 'open', headline: 'No answer', ...texts };
  if (!truth) return { outcome: 'open', headline: 'Not assessed yet', ...texts };
  if (answer.breach !== (truth.breached !== null)) {
    return {
      outcome: 'incorrect',
      headline: answer.breach
        ? 'Incorrect: a breach was reported where there is none'
        : 'Incorrect: the breach was missed',
      ...texts,
    };
  }
  if (truth.breached !== null && answer.wall !== truth.breached) {
    return {
      outcome: 'incorrect',
      headline:
        answer.wall === null
          ? 'Incorrect: a breach was reported, but no wall was named'
          : 'Incorrect: a breach was reported, but in another wall',
      ...texts,
    };
  }
  return { outcome: 'correct', headline: 'Correct', ...texts };
}

function probingAnswerText(answer: Answer | null): string {
  if (!answer) return 'No answer was given.';
  const confidence = answer.confidence === null ? '' : ` Confidence ${formatShare(answer.confidence)}.`;
  if (!answer.breach) return `No breach.${confidence}`;
  return `A breach${answer.depth_m === null ? ', no depth named' : ` at ${formatLength(answer.depth_m)}`}.${confidence}`;
}

function scenarioText(scenario: Scenario | null): string {
  if (!scenario) return 'Not released for this trial.';
  const [wall] = scenario.walls;
  if (!wall) return `${scenario.name}: no breach.`;
  return `${scenario.name}: breach at ${scenario.walls.map(({ position_m }) => formatLength(position_m)).join(' and ')}.`;
}

/** Probing: compares whether a breach was reported; its depth is shown but not assessed. */
export function judgeProbing(answer: Answer | null, scenario: Scenario | null): Judgement {
  const texts = { given: probingAnswerText(answer), truth: scenarioText(scenario) };
  if (!answer) return { outcome: 'open', headline: 'No answer', ...texts };
  if (!scenario) return { outcome: 'open', headline: 'Not assessed yet', ...texts };
  const there = scenario.walls.length > 0;
  if (answer.breach === there) return { outcome: 'correct', headline: 'Correct', ...texts };
  return {
    outcome: 'incorrect',
    headline: there ? 'Incorrect: the breach was missed' : 'Incorrect: a breach was reported where there is none',
    ...texts,
  };
}
