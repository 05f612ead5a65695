import type { Trainee } from '@/api';
import { curve, Plane } from '@/charts';
import { formatCount } from '@/units';
import styles from './trainees.module.css';

/** The sums trial by trial: towards competence, and from its signal on towards relapse. */
export function CusumChart({ trainee }: { readonly trainee: Trainee }) {
  const { attempts, rule, competent_at_trial: signal, relapse_at_trial: relapse } = trainee;
  const most = attempts.reduce((top, { sum, relapse_sum }) => Math.max(top, sum, relapse_sum ?? 0), rule.threshold);
  const watched = attempts.filter(({ relapse_sum }) => relapse_sum !== null);
  const summary = `Sum over ${formatCount(attempts.length)} trials. ${signal === null ? 'The threshold is not reached.' : `Competence is signalled at trial ${formatCount(signal)}.`} ${relapse === null ? '' : `Relapse is signalled at trial ${formatCount(relapse)}.`}`;
  const last = Math.max(attempts.length, 1);
  return (
    <>
      <Plane
        across={{ title: 'trial', from: 0, to: last }}
        up={{ title: 'sum', from: 0, to: most * 1.1 }}
        height_px={230}
        summary={summary}
      >
        {(places) => (
          <>
            <g className={styles.threshold}>
              <line x1={places.x(0)} x2={places.x(last)} y1={places.y(rule.threshold)} y2={places.y(rule.threshold)} />
              <text x={places.x(0) + 4} y={places.y(rule.threshold) - 4}>
                competent
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
                  relapse
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
          towards competence
        </li>
        {watched.length > 0 ? (
          <li>
            <i data-key="relapse" />
            towards relapse
          </li>
        ) : null}
        <li>
          <i data-key="right" />
          correct
        </li>
        <li>
          <i data-key="wrong" />
          incorrect
        </li>
      </ul>
    </>
  );
}
