import { useState } from 'react';
import type { MetricFacts, Trainee } from '@/api';
import { curve, Plane } from '@/charts';
import { say } from '@/language';
import { Select } from '@/ui';
import { formatFigure, formatShare, share, shownUnit, shownValue, type Share } from '@/units';
import { runningShare } from './standing';
import styles from './trainees.module.css';

function RightChart({ trainee }: { readonly trainee: Trainee }) {
  const { attempts, rule } = trainee;
  const running = runningShare(attempts.map(({ correct }) => correct));
  const now = running.at(-1) ?? null;
  const last = Math.max(attempts.length, 1);
  const wanted = 1 - rule.adequate;
  return (
    <Plane
      across={{ title: say('trial'), from: 0, to: last }}
      up={{ title: say('correct, last ten trials, %'), from: 0, to: 100 }}
      height_px={230}
      summary={say('Share of correct answers in the last ten trials: {now} now; {wanted} is adequate.', {
        now: now === null ? say('too few trials') : formatShare(share(now)),
        wanted: formatShare(wanted as Share),
      })}
      data={{
        name: `${trainee.trainee} correct answers`,
        columns: ['trial', 'correct', 'share_of_last_ten'],
        rows: attempts.map(({ number, correct }, i) => [number, Number(correct), running[i] ?? null]),
      }}
    >
      {(places) => (
        <>
          <g className={styles.threshold}>
            <line x1={places.x(0)} x2={places.x(last)} y1={places.y(100 * wanted)} y2={places.y(100 * wanted)} />
            <text x={places.x(0) + 4} y={places.y(100 * wanted) - 4}>
              {say('adequate')}
            </text>
          </g>
          <path
            d={curve(
              running.map((value, i) => [i + 1, value === null ? Number.NaN : 100 * value] as const),
              places,
            )}
            className={styles.sum}
          />
          {attempts.map(({ number, correct }) => (
            <circle
              key={number}
              cx={places.x(number)}
              cy={places.y(correct ? 100 : 0)}
              r={3}
              className={styles.answer}
              data-right={correct}
            />
          ))}
        </>
      )}
    </Plane>
  );
}

function ScoreChart({ trainee, metric }: { readonly trainee: Trainee; readonly metric: MetricFacts }) {
  const points = trainee.attempts.flatMap(({ number, scores }) => {
    const value = scores[metric.id];
    return value === null || value === undefined ? [] : [{ number, value, shown: shownValue(value, metric.unit) }];
  });
  const fit = trainee.scores.find(({ score }) => score === metric.id);
  const last = Math.max(trainee.attempts.length, 1);
  const most = points.reduce((top, { shown }) => Math.max(top, shown), 1e-9),
    least = Math.min(0, ...points.map(({ shown }) => shown));
  const mean = points.reduce((sum, { shown }) => sum + shown, 0) / Math.max(points.length, 1);
  const fitted =
    fit?.first !== undefined && fit.rate !== undefined
      ? Array.from({ length: last }, (_, i) => [i + 1, (fit.first ?? 0) * (i + 1) ** -(fit.rate ?? 0) * mean] as const)
      : [];
  const ratio = fit?.share_left_when_trials_double;
  return (
    <>
      <Plane
        across={{ title: say('trial'), from: 0, to: last }}
        up={{
          title: `${say(metric.label)}${shownUnit(metric.unit) === '' ? '' : `, ${shownUnit(metric.unit)}`}`,
          from: least,
          to: most * 1.08,
        }}
        height_px={230}
        summary={`${say('{metric} over {count} trials.', { metric: say(metric.label), count: points.length })}${ratio === undefined ? '' : ` ${say('Each doubling of the number of trials reduces it to {share}.', { share: formatShare(share(ratio)) })}`}`}
        data={{
          name: `${trainee.trainee} ${metric.label}`,
          columns: ['trial', `${metric.id}_in_${metric.unit === '1' ? 'ones' : metric.unit}`],
          rows: trainee.attempts.map(({ number, scores }) => [number, scores[metric.id] ?? null]),
        }}
      >
        {(places) => (
          <>
            {fitted.length > 1 ? <path d={curve(fitted, places)} className={styles.fitted} /> : null}
            {points.map(({ number, shown }) => (
              <circle key={number} cx={places.x(number)} cy={places.y(shown)} r={3.5} className={styles.point} />
            ))}
          </>
        )}
      </Plane>
      <p className={styles.muted}>
        {ratio === undefined
          ? (fit?.note ?? '')
          : say('Each doubling of the number of trials reduces it to {share} (p = {p}), adjusted for scenario.', {
              share: formatShare(share(ratio)),
              p: formatFigure(fit?.rate_p ?? null, '', 2),
            })}
      </p>
    </>
  );
}

/** Learning curve: correct answers, or a chosen measure. */
export function LearningChart({
  trainee,
  metrics,
}: {
  readonly trainee: Trainee;
  readonly metrics: readonly MetricFacts[];
}) {
  const [picked, setPicked] = useState('right');
  const known = trainee.scores.flatMap(({ score }) => metrics.filter(({ id }) => id === score));
  const metric = known.find(({ id }) => id === picked);
  return (
    <div className={styles.stack}>
      <div className={styles.pick}>
        <Select
          label={<span className="hidden-visually">{say('Measure')}</span>}
          value={picked}
          onChange={(event) => setPicked(event.target.value)}
          options={[
            { value: 'right', text: say('Correct answers') },
            ...known.map(({ id, label }) => ({ value: id, text: say(label) })),
          ]}
        />
      </div>
      {metric ? <ScoreChart trainee={trainee} metric={metric} /> : <RightChart trainee={trainee} />}
    </div>
  );
}
