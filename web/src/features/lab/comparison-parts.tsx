import type { Comparison, LabRun } from '@/api';
import { marked, say } from '@/language';
import { Bar, Facts, Scroll, Term } from '@/ui';
import { formatDuration, formatFigure, formatShare, kNone, share } from '@/units';
import styles from './lab.module.css';
import type { Names } from './overlay';
import { channelNameOf, channelUnit, trialCount } from './names';

export const kFloorMeaning = marked(
  'The error that noise alone causes, estimated from the measurements themselves. No model can have a smaller error.',
);
export const kErrorMeaning = marked('Root mean square of measured − simulated over all judged samples.');
const kJudgedMeaning = marked(
  'Samples where the motion is known well enough to judge the model. Left out: samples at a border between layers, and samples whose motion is too noisy.',
);
export const kExplainedMeaning = marked(
  'Share of the variation beyond noise that the model reproduces: 100 % at the noise floor, 0 % for a model that is no better than the mean.',
);

export const explained = (value: number | null | undefined) =>
  value === null || value === undefined
    ? kNone
    : value < 0
      ? say('below 0 %')
      : formatShare(share(Math.min(value, 1)), 1);

export const primaryOf = (comparison: Comparison) =>
  comparison.channels.find(({ name }) => name === comparison.primary) ?? comparison.channels[0];

/** Unit of the error of a run; newton until its comparison is known. */
export function primaryUnit({ comparisons }: Pick<LabRun, 'comparisons'>): string {
  return channelUnit(comparisons ? (primaryOf(comparisons.before)?.name ?? comparisons.before.primary) : 'force_N');
}

/** The headline: how large the error is, what of it is noise, how much is explained. */
export function Headline({
  before,
  after,
  names,
}: {
  readonly before: Comparison;
  readonly after: Comparison | null;
  readonly names: Names;
}) {
  const was = primaryOf(before),
    is = after ? primaryOf(after) : null;
  if (!was) return null;
  const unit = channelUnit(was.name);
  const judged = before.judgements.find(({ judgement }) => judgement === 'judged');
  return (
    <Facts
      facts={[
        {
          name: <Term definition={say(kErrorMeaning)}>{say('Error, {model}', { model: names.before })}</Term>,
          value: (
            <strong className={styles.big} data-part="error-before">
              {formatFigure(was.rmse, unit)}
            </strong>
          ),
        },
        ...(is
          ? [
              {
                name: (
                  <Term definition={say(kErrorMeaning)}>{say('Error, {model}', { model: names.after ?? '' })}</Term>
                ),
                value: (
                  <strong className={styles.big} data-part="error-after">
                    {formatFigure(is.rmse, unit)}
                  </strong>
                ),
              },
            ]
          : []),
        {
          name: <Term definition={say(kFloorMeaning)}>{say('Noise floor')}</Term>,
          value: <strong className={styles.big}>{formatFigure(was.noise_floor, unit)}</strong>,
        },
        {
          name: <Term definition={say(kExplainedMeaning)}>{say('Explained')}</Term>,
          value: (
            <strong className={styles.big}>
              {explained(was.explained)}
              {is ? ` → ${explained(is.explained)}` : ''}
            </strong>
          ),
        },
        ...(judged
          ? [
              {
                name: <Term definition={say(kJudgedMeaning)}>{say('Judged')}</Term>,
                value: (
                  <strong className={styles.big}>
                    {say('{share} of the samples', { share: formatShare(judged.share) })}
                  </strong>
                ),
              },
            ]
          : []),
        {
          name: say('Recorded'),
          value: <strong className={styles.big}>{trialCount(before.trials.length)}</strong>,
        },
      ]}
    />
  );
}

/** Error of each channel beside its floor. */
export function Channels({
  before,
  after,
  names,
  rig,
}: {
  readonly before: Comparison;
  readonly after: Comparison | null;
  readonly names: Names;
  readonly rig: string | null;
}) {
  return (
    <Scroll label={say('Error by channel')}>
      <table className={styles.table}>
        <caption className="hidden-visually">{say('Error by channel')}</caption>
        <thead>
          <tr>
            <th scope="col">{say('Channel')}</th>
            <th scope="col" className={styles.number}>
              {say('Error, {model}', { model: names.before })}
            </th>
            {after ? (
              <th scope="col" className={styles.number}>
                {say('Error, {model}', { model: names.after ?? '' })}
              </th>
            ) : null}
            <th scope="col" className={styles.number}>
              {say('Noise floor')}
            </th>
            <th scope="col" className={styles.number}>
              R²
            </th>
            <th scope="col" className={styles.number}>
              {say('Explained')}
            </th>
          </tr>
        </thead>
        <tbody>
          {before.channels.map((channel) => {
            const unit = channelUnit(channel.name),
              better = after?.channels.find(({ name }) => name === channel.name);
            return (
              <tr key={channel.name}>
                <th scope="row">{channelNameOf(channel.name, rig)}</th>
                <td className={styles.number}>{formatFigure(channel.rmse, unit)}</td>
                {after ? <td className={styles.number}>{formatFigure(better?.rmse, unit)}</td> : null}
                <td className={styles.number}>{formatFigure(channel.noise_floor, unit)}</td>
                <td className={styles.number}>{formatFigure((better ?? channel).r2, '', 4)}</td>
                <td className={styles.number}>{explained((better ?? channel).explained)}</td>
              </tr>
            );
          })}
        </tbody>
      </table>
    </Scroll>
  );
}

export function Phases({ comparison }: { readonly comparison: Comparison }) {
  if (comparison.phases.length === 0)
    return <p className={styles.muted}>{say('The measurements define no phases.')}</p>;
  const unit = channelUnit(comparison.primary);
  return (
    <Scroll label={say('Error by phase')}>
      <table className={styles.table}>
        <caption className="hidden-visually">{say('Error by phase')}</caption>
        <thead>
          <tr>
            <th scope="col">{say('Phase')}</th>
            <th scope="col" className={styles.number}>
              {say('Error')}
            </th>
            <th scope="col">{say('Share of the error')}</th>
            <th scope="col">{say('Share of the time')}</th>
          </tr>
        </thead>
        <tbody>
          {comparison.phases.map((phase) => (
            <tr key={phase.phase}>
              <th scope="row">{phase.phase}</th>
              <td className={styles.number}>{formatFigure(phase.rmse, unit)}</td>
              <td>
                <span className={styles.bar}>
                  <Bar share={phase.share_of_error} tone="bad" />
                  <span>{formatShare(phase.share_of_error)}</span>
                </span>
              </td>
              <td>
                <span className={styles.bar}>
                  <Bar share={phase.share_of_time} tone="muted" />
                  <span>{formatShare(phase.share_of_time)}</span>
                </span>
              </td>
            </tr>
          ))}
        </tbody>
      </table>
    </Scroll>
  );
}

interface Choosing {
  readonly before: Comparison;
  readonly after: Comparison | null;
  readonly chosen: string;
  readonly choose: (trial: string) => void;
}

/** The trials with their errors, to choose one. */
export function TrialChoice({ before, after, chosen, choose }: Choosing) {
  const unit = channelUnit(before.primary),
    worst = before.trials.reduce((top, { rmse }) => Math.max(top, rmse ?? 0), 1e-12);
  return (
    <fieldset className={styles.trials}>
      <legend>{say('Trial')}</legend>
      {before.trials.map((trial) => {
        const better = after?.trials.find(({ id }) => id === trial.id);
        return (
          <label key={trial.id} className={styles.trial}>
            <input type="radio" name="trial" checked={trial.id === chosen} onChange={() => choose(trial.id)} />
            <span className={styles.trialText}>
              <span className={styles.choiceName}>{trial.id}</span>
              <span className={styles.muted}>
                {formatFigure(trial.rmse, unit)}
                {better ? ` → ${formatFigure(better.rmse, unit)}` : ''} · {formatDuration(trial.duration_s)}
              </span>
              <Bar share={(trial.rmse ?? 0) / worst} tone="bad" />
            </span>
          </label>
        );
      })}
    </fieldset>
  );
}
