import type { Trainee } from '@/api';
import { curve, Plane } from '@/charts';
import { say } from '@/language';
import { formatCount, formatDate } from '@/units';
import styles from './trainees.module.css';

/** The day of a trial, by its number. */
const startOf = (attempts: Trainee['attempts'], trial: number) => {
  const found = attempts.find(({ number }) => number === trial);
  return found && found.started_utc_us !== null ? formatDate(found.started_utc_us) : '';
};

/** The sums trial by trial: towards competence, and from its signal on towards relapse. */
export function CusumChart({ trainee }: { readonly trainee: Trainee }) {
  const { attempts, rule, competent_at_trial: signal, relapses } = trainee;
  const most = attempts.reduce((top, { sum, relapse_sum }) => Math.max(top, sum, relapse_sum ?? 0), rule.threshold);
  const watched = attempts.filter(({ relapse_sum }) => relapse_sum !== null);
  const summary = [
    say('Sum over {count} trials.', { count: formatCount(attempts.length) }),
    signal === null
      ? say('The threshold is not reached.')
      : say('Competence is signalled at trial {trial}.', { trial: formatCount(signal) }),
    ...relapses.map(({ at_trial, recovered_at_trial: back }) =>
      back === null
        ? say('Relapse is signalled at trial {trial}.', { trial: formatCount(at_trial) })
        : say('Relapse is signalled at trial {trial} and has ended at trial {end}.', {
            trial: formatCount(at_trial),
            end: formatCount(back),
          }),
    ),
  ].join(' ');
  const last = Math.max(attempts.length, 1);
  return (
    <>
      <Plane
        across={{ title: say('trial'), from: 0, to: last }}
        up={{ title: say('sum'), from: 0, to: most * 1.1 }}
        height_px={230}
        summary={summary}
        data={{
          name: `${trainee.trainee} competence`,
          columns: ['trial', 'correct', 'lc_cusum', 'relapse_cusum'],
          rows: attempts.map(({ number, correct, sum, relapse_sum }) => [number, Number(correct), sum, relapse_sum]),
        }}
      >
        {(places) => (
          <>
            <g className={styles.threshold}>
              <line x1={places.x(0)} x2={places.x(last)} y1={places.y(rule.threshold)} y2={places.y(rule.threshold)} />
              <text x={places.x(0) + 4} y={places.y(rule.threshold) - 4}>
                {say('competent')}
              </text>
            </g>
            {signal === null ? null : (
              <g className={styles.alarm}>
                <line
                  x1={places.x(signal)}
                  x2={places.x(last)}
                  y1={places.y(rule.relapse)}
                  y2={places.y(rule.relapse)}
                />
                <text x={places.x(last)} y={places.y(rule.relapse) - 4} textAnchor="end">
                  {say('relapse')}
                </text>
              </g>
            )}
            <path
              d={curve([[0, 0], ...attempts.map(({ number, sum }) => [number, sum] as const)], places)}
              className={styles.sum}
            />
            {watched.length > 0 ? (
              <path
                d={curve(
                  [[signal ?? 0, 0], ...watched.map(({ number, relapse_sum }) => [number, relapse_sum ?? 0] as const)],
                  places,
                )}
                className={styles.relapseSum}
              />
            ) : null}
            {relapses.map(({ at_trial, recovered_at_trial: back }) =>
              back === null ? null : (
                <g key={at_trial} className={styles.recovered}>
                  <line x1={places.x(back)} x2={places.x(back)} y1={places.y(0)} y2={places.y(rule.relapse)} />
                  <text
                    x={places.x(back) + (back > last / 2 ? -4 : 4)}
                    y={places.y(rule.relapse) - 18}
                    textAnchor={back > last / 2 ? 'end' : 'start'}
                  >
                    {say('recovered {date}', { date: startOf(attempts, back) })}
                  </text>
                </g>
              ),
            )}
            {attempts.map(({ number, sum, correct }) => (
              <circle
                key={number}
                cx={places.x(number)}
                cy={places.y(sum)}
                r={3.5}
                className={styles.answer}
                data-right={correct}
              />
            ))}
          </>
        )}
      </Plane>
      <ul className={styles.key}>
        <li>
          <i data-key="sum" />
          {say('towards competence')}
        </li>
        {watched.length > 0 ? (
          <li>
            <i data-key="relapse" />
            {say('towards relapse')}
          </li>
        ) : null}
        <li>
          <i data-key="right" />
          {say('correct')}
        </li>
        <li>
          <i data-key="wrong" />
          {say('incorrect')}
        </li>
      </ul>
    </>
  );
}
