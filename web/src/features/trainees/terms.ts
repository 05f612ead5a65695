import type { TraineeSummary } from '@/api';
import { marked } from '@/language';
import type { Tone } from '@/ui';

export const kStateLabels: Record<TraineeSummary['state'], { label: string; tone: Tone; description: string }> = {
  learning: { label: marked('learning'), tone: 'accent', description: marked('Competence has not been reached yet.') },
  competent: {
    label: marked('competent'),
    tone: 'good',
    description: marked('The sum over correct and incorrect answers has reached the threshold.'),
  },
  relapsed: {
    label: marked('relapsed'),
    tone: 'bad',
    description: marked('Competence was reached before; since then, incorrect answers have accumulated.'),
  },
};

export const kCusum = marked(
  'A running sum over the trials (LC-CUSUM): a correct answer increases it, an incorrect answer decreases it, never below zero. When it reaches the threshold, competence is signalled.',
);
export const kRelapse = marked(
  'After this signal, a second sum detects relapse: incorrect answers increase it, correct answers decrease it.',
);
export const kInterval = marked('95 % interval (Wilson): range of the true share, given the number of trials.');
export const kCalibration = marked(
  'Stated confidence against the share of correct answers. On the diagonal, confidence matches accuracy; below the diagonal, confidence is too high.',
);
export const kBehind = marked(
  'Correct answers of the other trainees of the cohort at the same trial numbers. A trainee is called behind where the last ten answers are correct less often than that (Fisher’s exact test, p ≤ 0.05): of forty trainees who are not, one is called so by chance.',
);
