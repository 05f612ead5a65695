import type { CaseSummary } from './teaching-schemas';

/** The words for whether the breaches of a case can be told by feel, and their tone. */
export const kFeltSigns = {
  untried: { tone: 'neutral', text: 'not yet tried by feel' },
  told: { tone: 'good', text: 'every breach can be felt' },
  not_told: { tone: 'bad', text: 'not every breach can be felt' },
  not_known: { tone: 'warn', text: 'no certificate' },
} as const satisfies Record<CaseSummary['felt'], { tone: string; text: string }>;
