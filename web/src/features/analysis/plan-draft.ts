/** An analysis plan as it is being written. Pure. */
import { marked, say } from '@/language';

export interface Question {
  readonly method: string;
  readonly formula: string;
  readonly question: string;
  readonly primary: boolean;
}
export interface PlanDraft {
  readonly title: string;
  readonly question: string;
  readonly endpoint: string;
  readonly alpha: string;
  readonly correction: string;
  readonly questions: readonly Question[];
  readonly exclusion: string;
  readonly reason: string;
}

export const kBlankPlan: PlanDraft = {
  title: '',
  question: '',
  endpoint: '',
  alpha: '0.05',
  correction: 'holm',
  questions: [],
  exclusion: '',
  reason: '',
};

export const kCorrections = [
  { value: 'holm', text: 'Holm' },
  { value: 'hommel', text: 'Hommel' },
  { value: 'bonferroni', text: 'Bonferroni' },
  { value: 'bh', text: 'Benjamini–Hochberg' },
  { value: 'none', text: marked('none') },
] as const;

/** tractus-plan/1, or what is still missing. */
export function planOf(draft: PlanDraft): { plan: Record<string, unknown> } | { missing: string } {
  const alpha = Number(draft.alpha);
  if (draft.title.trim() === '') return { missing: say('Enter a title.') };
  if (draft.endpoint === '') return { missing: say('Choose an endpoint.') };
  if (!(alpha > 0 && alpha < 0.5)) return { missing: say('α must be greater than 0 and less than 0.5.') };
  if (draft.questions.length === 0) return { missing: say('Add at least one analysis.') };
  return {
    plan: {
      format: 'tractus-plan/1',
      title: draft.title.trim(),
      question: draft.question.trim(),
      endpoint: draft.endpoint,
      subject: 'participant',
      alpha,
      correction: draft.correction,
      exclusions:
        draft.exclusion.trim() === ''
          ? []
          : [{ where: draft.exclusion.trim(), reason: draft.reason.trim() || 'as planned' }],
      analyses: draft.questions.map((one, i) => ({
        id: `analysis-${i + 1}`,
        question: one.question,
        ...(one.primary ? { family: 'primary' } : {}),
        method: one.method,
        formula: one.formula,
      })),
    },
  };
}
