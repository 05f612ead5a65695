import { curve, Plane } from '@/charts';
import { marked, say } from '@/language';
import { Scroll, Term } from '@/ui';
import { formatFigure } from '@/units';
import styles from './error-steps.module.css';

export interface ErrorStep {
  readonly name: string;
  readonly rmse: number | null;
  readonly held_out_rmse: number | null;
}

interface Props {
  readonly steps: readonly ErrorStep[];
  readonly noise_floor: number | null;
  readonly unit: string;
}

export const kHeldOutMeaning = marked(
  'The error on trials that the fit did not use: an estimate of the error on the next recording.',
);

/** Error after each step, on fitted and on held-out trials, with the noise floor. */
export function ErrorSteps({ steps, noise_floor, unit }: Props) {
  const all = steps
    .flatMap(({ rmse, held_out_rmse }) => [rmse, held_out_rmse])
    .filter((value): value is number => value !== null);
  const positive = [...all, ...(noise_floor === null ? [] : [noise_floor])].filter((value) => value > 0);
  const most = Math.max(...positive, 1e-12),
    least = Math.min(...positive, most);
  const log = most / least > 12;
  const summary = say('Error step by step: {steps}. Noise floor: {floor}.', {
    steps: steps
      .map(({ name, rmse, held_out_rmse }) =>
        say('{step} {error}, held out {held_out}', {
          step: name,
          error: formatFigure(rmse, unit),
          held_out: formatFigure(held_out_rmse, unit),
        }),
      )
      .join('; '),
    floor: formatFigure(noise_floor, unit),
  });
  const line = (of: 'rmse' | 'held_out_rmse') => steps.map((step, i) => [i, step[of] ?? Number.NaN] as const);
  return (
    <div className={styles.falls} data-part="error-steps">
      <Plane
        across={{
          title: '',
          from: -0.5,
          to: Math.max(steps.length, 2) - 0.5,
          ticks: steps.map(({ name }, at) => ({ at, text: name })),
        }}
        up={{
          title: log ? say('error, {unit} (logarithmic)', { unit }) : say('error, {unit}', { unit }),
          from: log ? least / 1.8 : 0,
          to: log ? most * 1.4 : most * 1.12,
          log,
        }}
        height_px={260}
        summary={summary}
        data={{
          name: say('error by step'),
          columns: ['model', `error_of_fitted_trials_in_${unit}`, `error_of_held_out_trials_in_${unit}`],
          rows: steps.map(({ name, rmse, held_out_rmse }) => [name, rmse, held_out_rmse]),
        }}
      >
        {(places) => (
          <>
            {noise_floor !== null && noise_floor > 0 ? (
              <g className={styles.floor}>
                <line
                  x1={places.x(-0.5)}
                  x2={places.x(Math.max(steps.length, 2) - 0.5)}
                  y1={places.y(noise_floor)}
                  y2={places.y(noise_floor)}
                />
                <text x={places.x(-0.5) + 4} y={places.y(noise_floor) - 4}>
                  {say('noise floor {floor}', { floor: formatFigure(noise_floor, unit) })}
                </text>
              </g>
            ) : null}
            <path d={curve(line('held_out_rmse'), places)} className={styles.line} data-series="held" />
            <path d={curve(line('rmse'), places)} className={styles.line} data-series="fit" />
            {steps.map((step, i) => (
              <g key={i}>
                {step.held_out_rmse === null ? null : (
                  <circle
                    cx={places.x(i)}
                    cy={places.y(step.held_out_rmse)}
                    r={6}
                    className={styles.dot}
                    data-series="held"
                  />
                )}
                {step.rmse === null ? null : (
                  <circle cx={places.x(i)} cy={places.y(step.rmse)} r={4} className={styles.dot} data-series="fit" />
                )}
              </g>
            ))}
          </>
        )}
      </Plane>
      <Scroll label={say('Error by step')}>
        <table className={styles.table}>
          <caption className="hidden-visually">{say('Error by step')}</caption>
          <thead>
            <tr>
              <th scope="col">{say('Model')}</th>
              <th scope="col">
                <i data-series="fit" />
                {say('Fitted trials')}
              </th>
              <th scope="col">
                <i data-series="held" />
                <Term align="end" definition={say(kHeldOutMeaning)}>
                  {say('Held-out trials')}
                </Term>
              </th>
            </tr>
          </thead>
          <tbody>
            {steps.map((step, i) => (
              <tr key={i}>
                <th scope="row">{step.name}</th>
                <td>{formatFigure(step.rmse, unit)}</td>
                <td data-part="held-out">{formatFigure(step.held_out_rmse, unit)}</td>
              </tr>
            ))}
          </tbody>
        </table>
      </Scroll>
    </div>
  );
}
