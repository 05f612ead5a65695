import type { Trial } from '@/api';
import { Badge, Card, Facts } from '@/ui';
import { judge, judgeProbing } from './judgement';
import styles from './verdict.module.css';

const kTone = { right: 'good', wrong: 'bad', open: 'neutral' } as const;
const kSign = { right: '✓', wrong: '✗', open: '–' } as const;

export function Verdict({ trial }: { readonly trial: Trial }) {
  const { outcome, headline, said, truth: known } =
    trial.rig === 'probing' ? judgeProbing(trial.answer, trial.scenario) : judge(trial.answer, trial.truth);
  return (
    <Card title="Answer" aside={<Badge tone={kTone[outcome]}><span aria-hidden="true">{kSign[outcome]}</span>{outcome === 'open' ? 'not judged' : outcome}</Badge>}>
      <p className={styles.headline}>{headline}.</p>
      <Facts facts={[{ name: 'Said', value: said }, { name: 'In truth', value: known }]} />
    </Card>
  );
}
