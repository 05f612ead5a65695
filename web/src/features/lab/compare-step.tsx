import { useState } from 'react';
import type { Comparison, LabRun, ModelVersion } from '@/api';
import { say } from '@/language';
import { Card, Select } from '@/ui';
import { formatDateTime } from '@/units';
import { Channels, Headline, Phases, primaryOf, TrialChoice } from './comparison-parts';
import { Distributions } from './distributions';
import styles from './lab.module.css';
import { Overlay, type Names } from './overlay';
import { channelNameOf } from './names';

export interface Drawable {
  readonly run: LabRun;
  readonly before: Comparison;
  readonly after: Comparison | null;
  readonly names: Names;
  readonly rig: string | null;
}

/** Channels that were recorded: a norm over several has no series of its own. */
export const recorded = (comparison: Comparison) =>
  comparison.channels.filter(({ measured }) => measured !== undefined);

const worstTrial = (comparison: Comparison) =>
  comparison.trials.reduce(
    (worst, trial) => ((trial.rmse ?? 0) > (worst?.rmse ?? -1) ? trial : worst),
    comparison.trials[0],
  );

/** One trial drawn, with what chooses which and which channel. */
export function Series({ drawable, region = null }: { readonly drawable: Drawable; readonly region?: number | null }) {
  const { run, before, after, names, rig } = drawable;
  const channels = recorded(before);
  const first =
    channels.find(({ name }) => name === before.primary) ?? channels.find(({ name }) => name === 'fz_N') ?? channels[0];
  const [pickedTrial, setTrial] = useState<string | null>(null);
  const [pickedChannel, setChannel] = useState<string | null>(null);
  const trial = before.trials.find(({ id }) => id === pickedTrial) ?? worstTrial(before);
  const channel = channels.find(({ name }) => name === pickedChannel) ?? first;
  if (!trial || !channel) return <p>{say('There are no data to draw.')}</p>;
  return (
    <div className={styles.series}>
      <div className={styles.side}>
        {channels.length > 1 ? (
          <Select
            label={say('Channel')}
            value={channel.name}
            onChange={(event) => setChannel(event.target.value)}
            options={channels.map(({ name }) => ({ value: name, text: channelNameOf(name, rig) }))}
          />
        ) : null}
        <TrialChoice before={before} after={after} chosen={trial.id} choose={setTrial} />
      </div>
      <div className={styles.drawing}>
        <Overlay
          key={`${trial.id} ${region ?? ''}`}
          run={run.id}
          rig={rig}
          trial={trial}
          channel={channel.name}
          names={names}
          region={region}
        />
      </div>
    </div>
  );
}

interface Props {
  readonly drawable: Drawable;
  readonly versions: readonly ModelVersion[];
  readonly against: string | null;
  readonly setAgainst: (id: string | null) => void;
}

/** Model and measurements side by side. */
export function CompareStep({ drawable, versions, against, setAgainst }: Props) {
  const { before, after, names, rig } = drawable;
  const channels = recorded(before);
  const [picked, setPicked] = useState<string | null>(null);
  const shown =
    channels.find(({ name }) => name === picked) ??
    channels.find(({ name }) => name === primaryOf(before)?.name) ??
    channels[0];
  return (
    <>
      <Card
        title={say('Model error')}
        aside={
          versions.length > 0 ? (
            <Select
              label={<span className="hidden-visually">{say('Second version to compare')}</span>}
              value={against ?? ''}
              onChange={(event) => setAgainst(event.target.value === '' ? null : event.target.value)}
              options={[
                { value: '', text: say('No second version') },
                ...versions.map(({ id, name, note, made_utc_us }) => ({
                  value: id,
                  text: say('Compare with: {model} ({time})', {
                    model: note === '' ? name : `${name}, ${note}`,
                    time: formatDateTime(made_utc_us),
                  }),
                })),
              ]}
            />
          ) : null
        }
      >
        <Headline before={before} after={after} names={names} />
        <p className={styles.muted} data-part="as-published">
          {say(
            'The model as published, with all parameters unchanged. “Missing effects” first fits the parameters to these measurements and therefore starts from a smaller error.',
          )}
        </p>
      </Card>
      <Card title={say('Measured and simulated')}>
        <Series drawable={drawable} />
      </Card>
      {shown ? (
        <Card
          title={say('Error distribution')}
          aside={
            channels.length > 1 ? (
              <Select
                label={<span className="hidden-visually">{say('Channel of the distributions')}</span>}
                value={shown.name}
                onChange={(event) => setPicked(event.target.value)}
                options={channels.map(({ name }) => ({ value: name, text: channelNameOf(name, rig) }))}
              />
            ) : null
          }
        >
          <Distributions
            before={shown}
            after={after?.channels.find(({ name }) => name === shown.name) ?? null}
            names={names}
          />
        </Card>
      ) : null}
      <div className={styles.two}>
        <Card title={say('Error by channel')}>
          <Channels before={before} after={after} names={names} rig={rig} />
        </Card>
        <Card title={say('Error by phase')}>
          <Phases comparison={before} />
        </Card>
      </div>
    </>
  );
}
