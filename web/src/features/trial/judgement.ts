/** Compares the answer with the truth, by the rule of the metric answer_right. */
import type { Answer, Scenario, Truth } from '@/api';
import { marked, say } from '@/language';
import { wallName } from '@/ui';
import { formatLength, formatShare } from '@/units';

export interface Judgement {
  readonly outcome: 'correct' | 'incorrect' | 'open';
  readonly headline: string;
  readonly given: string;
  readonly truth: string;
}

const kIntactReported = marked('Incorrect: a breach was reported where there is none'),
  kMissed = marked('Incorrect: the breach was missed');

const confidenceText = ({ confidence }: Answer): string =>
  confidence === null ? '' : ` ${say('Confidence {share}.', { share: formatShare(confidence) })}`;

function palpationAnswerText(answer: Answer | null): string {
  if (!answer) return say('No answer was given.');
  if (!answer.breach) return say('No breach.') + confidenceText(answer);
  const breach =
    answer.wall === null
      ? say('A breach, no wall named.')
      : say('A breach of the {wall} wall.', { wall: wallName(answer.wall) });
  return breach + confidenceText(answer);
}

function truthText(truth: Truth | null): string {
  if (!truth) return say('Not released for this trial.');
  return truth.breached === null
    ? say('The tract is intact.')
    : say('The {wall} wall is breached.', { wall: wallName(truth.breached) });
}

export function judge(answer: Answer | null, truth: Truth | null): Judgement {
  const texts = { given: palpationAnswerText(answer), truth: truthText(truth) };
  if (!answer) return { outcome: 'open', headline: say('No answer'), ...texts };
  if (!truth) return { outcome: 'open', headline: say('Not assessed yet'), ...texts };
  if (answer.breach !== (truth.breached !== null)) {
    return {
      outcome: 'incorrect',
      headline: say(answer.breach ? kIntactReported : kMissed),
      ...texts,
    };
  }
  if (truth.breached !== null && answer.wall !== truth.breached) {
    return {
      outcome: 'incorrect',
      headline:
        answer.wall === null
          ? say('Incorrect: a breach was reported, but no wall was named')
          : say('Incorrect: a breach was reported, but in another wall'),
      ...texts,
    };
  }
  return { outcome: 'correct', headline: say('Correct'), ...texts };
}

function probingAnswerText(answer: Answer | null): string {
  if (!answer) return say('No answer was given.');
  if (!answer.breach) return say('No breach.') + confidenceText(answer);
  const breach =
    answer.depth_m === null
      ? say('A breach, no depth named.')
      : say('A breach at {depth}.', { depth: formatLength(answer.depth_m) });
  return breach + confidenceText(answer);
}

function scenarioText(scenario: Scenario | null): string {
  if (!scenario) return say('Not released for this trial.');
  const [wall] = scenario.walls;
  if (!wall) return say('{scenario}: no breach.', { scenario: scenario.name });
  const depths = scenario.walls.map(({ position_m }) => formatLength(position_m)).join(` ${say('and')} `);
  return say('{scenario}: breach at {depths}.', { scenario: scenario.name, depths });
}

/** Probing: compares whether a breach was reported; its depth is shown but not assessed. */
export function judgeProbing(answer: Answer | null, scenario: Scenario | null): Judgement {
  const texts = { given: probingAnswerText(answer), truth: scenarioText(scenario) };
  if (!answer) return { outcome: 'open', headline: say('No answer'), ...texts };
  if (!scenario) return { outcome: 'open', headline: say('Not assessed yet'), ...texts };
  const there = scenario.walls.length > 0;
  if (answer.breach === there) return { outcome: 'correct', headline: say('Correct'), ...texts };
  return {
    outcome: 'incorrect',
    headline: say(there ? kMissed : kIntactReported),
    ...texts,
  };
}
