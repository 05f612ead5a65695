import type { Trial } from '@/api';
import { marked, say } from '@/language';
import { Badge, Card, Facts } from '@/ui';
import { channelOf, type Channel } from './channel';
import { judge, judgeProbing } from './judgement';
import styles from './verdict.module.css';

const kTone = { correct: 'good', incorrect: 'bad', open: 'neutral' } as const;
const kOutcomes = {
  correct: marked('correct'),
  incorrect: marked('incorrect'),
  open: marked('not assessed'),
} as const;
const kSign = { correct: '✓', incorrect: '✗', open: '–' } as const;

const kChannelTone = { within: 'good', out: 'bad', unknown: 'neutral' } as const;
const kChannelLabels = {
  within: marked('within the bone'),
  out: marked('left the bone'),
  unknown: marked('unknown'),
} as const;

function Drilled({ channel }: { readonly channel: Channel }) {
  return (
    <Card
      title={say('Channel')}
      aside={<Badge tone={kChannelTone[channel.outcome]}>{say(kChannelLabels[channel.outcome])}</Badge>}
    >
      <p className={styles.headline}>{channel.headline}.</p>
      <Facts
        facts={[
          { name: say('Distance from the planned entry'), value: channel.entry },
          { name: say('Angle to the planned direction'), value: channel.direction },
          { name: say('Depth beyond the planned end'), value: channel.end },
          { name: say('Removed bone'), value: channel.removed },
        ]}
      />
    </Card>
  );
}

/** What was answered against what is there; of a trial that drilled, what the burr made. */
export function Verdict({ trial }: { readonly trial: Trial }) {
  const channel = channelOf(trial.metrics);
  if (channel) return <Drilled channel={channel} />;
  const {
    outcome,
    headline,
    given,
    truth: known,
  } = trial.rig === 'probing' ? judgeProbing(trial.answer, trial.scenario) : judge(trial.answer, trial.truth);
  return (
    <Card
      title={say('Answer')}
      aside={
        <Badge tone={kTone[outcome]}>
          <span aria-hidden="true">{kSign[outcome]}</span>
          {say(kOutcomes[outcome])}
        </Badge>
      }
    >
      <p className={styles.headline}>{headline}.</p>
      <Facts
        facts={[
          { name: say('Answer'), value: given },
          { name: say('Truth'), value: known },
        ]}
      />
    </Card>
  );
}
