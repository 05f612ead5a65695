import type { TraineeSummary } from '@/api';
import type { Tone } from '@/ui';

export const kStateLabels: Record<TraineeSummary['state'], { label: string; tone: Tone; description: string }> = {
  learning: { label: 'learning', tone: 'accent', description: 'Competence has not been reached yet.' },
  competent: {
    label: 'competent',
    tone: 'good',
    description: 'The sum over correct and incorrect answers has reached the threshold.',
  },
  relapsed: {
    label: 'relapsed',
    tone: 'bad',
    description: 'Competence was reached before; since then, incorrect answers have accumulated.',
  },
};

export const kCusum =
  'A running sum over the trials (LC-CUSUM): a correct answer increases it, an incorrect answer decreases it, never below zero. When it reaches the threshold, competence is signalled.';
export const kRelapse =
  'After this signal, a second sum detects relapse: incorrect answers increase it, correct answers decrease it.';
export const kInterval = '95 % interval (Wilson): range of the true share, given the number of trials.';
export const kCalibration =
  'Stated confidence against the share of correct answers. On the diagonal, confidence matches accuracy; below the diagonal, confidence is too high.';
export const kBehind =
  'Correct answers of the other trainees of the cohort at the same trial numbers. A trainee is called behind where the last ten answers are correct less often than that (Fisher’s exact test, p ≤ 0.05): of forty trainees who are not, one is called so by chance.';
