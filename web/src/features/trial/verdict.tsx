import type { Trial } from '@/api';
import { Badge, Card, Facts } from '@/ui';
import { channelOf, type Channel } from './channel';
import { judge, judgeProbing } from './judgement';
import styles from './verdict.module.css';

const kTone = { right: 'good', wrong: 'bad', open: 'neutral' } as const;
const kSign = { right: '✓', wrong: '✗', open: '–' } as const;

const kChannelTone = { within: 'good', out: 'bad', unknown: 'neutral' } as const;
const kChannelWords = { within: 'within the bone', out: 'left the bone', unknown: 'not known' } as const;

function Drilled({ channel }: { readonly channel: Channel }) {
  return (
    <Card title="Channel" aside={<Badge tone={kChannelTone[channel.outcome]}>{kChannelWords[channel.outcome]}</Badge>}>
      <p className={styles.headline}>{channel.headline}.</p>
      <Facts facts={[
        { name: 'Off the planned entry', value: channel.entry },
        { name: 'Off its direction', value: channel.direction },
        { name: 'Beyond its end', value: channel.end },
        { name: 'Bone drilled away', value: channel.removed },
      ]} />
    </Card>
  );
}

/** What was answered against what is there; of a trial that drilled, what the burr made. */
export function Verdict({ trial }: { readonly trial: Trial }) {
  const channel = channelOf(trial.metrics);
  if (channel) return <Drilled channel={channel} />;
  const { outcome, headline, said, truth: known } =
    trial.rig === 'probing' ? judgeProbing(trial.answer, trial.scenario) : judge(trial.answer, trial.truth);
  return (
    <Card title="Answer" aside={<Badge tone={kTone[outcome]}><span aria-hidden="true">{kSign[outcome]}</span>{outcome === 'open' ? 'not judged' : outcome}</Badge>}>
      <p className={styles.headline}>{headline}.</p>
      <Facts facts={[{ name: 'Said', value: said }, { name: 'In truth', value: known }]} />
    </Card>
  );
}
