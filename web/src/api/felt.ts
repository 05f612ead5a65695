import { marked } from '@/language';
import type { CaseSummary } from './teaching-schemas';

/** The words for whether the breaches of a case can be told by feel, and their tone. */
export const kFeltSigns = {
  untried: { tone: 'neutral', text: marked('not yet tried by feel') },
  told: { tone: 'good', text: marked('every breach can be felt') },
  not_told: { tone: 'bad', text: marked('not every breach can be felt') },
  not_known: { tone: 'warn', text: marked('no certificate') },
} as const satisfies Record<CaseSummary['felt'], { tone: string; text: string }>;
