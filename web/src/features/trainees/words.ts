import type { TraineeSummary } from '@/api';
import type { Tone } from '@/ui';

export const kState: Record<TraineeSummary['state'], { word: string; tone: Tone; says: string }> = {
  learning: { word: 'learning', tone: 'accent', says: 'No signal of competence yet.' },
  competent: { word: 'competent', tone: 'good', says: 'The sum of right and wrong answers has reached the threshold.' },
  relapsed: { word: 'relapsed', tone: 'bad', says: 'Competent before; since then wrong answers have gathered again.' },
};

export const kCusum = 'A running sum over the trials (LC-CUSUM): a right answer adds, a wrong one takes off, never below zero. At the threshold competence is signalled.';
export const kRelapse = 'From the signal on a second sum watches for relapse: wrong answers add, right ones take off.';
export const kInterval = '95 % interval (Wilson): where the true share may lie, given so many trials.';
export const kCalibration = 'How sure somebody said to be against how often they were right. On the diagonal confidence is worth what it says; below it is too high.';
