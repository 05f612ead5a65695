import type { CalibrationBin, Trainee } from '@/api';
import { Plane } from '@/charts';
import { marked, say } from '@/language';
import { Badge, Scroll } from '@/ui';
import { formatCount, formatShare, kNone } from '@/units';
import styles from './trainees.module.css';

/** A share with its interval on a line from 0 to 100 %; the numbers stand beside it. */
export function Whisker({ value, low, high }: { readonly value: number; readonly low: number; readonly high: number }) {
  return (
    <svg viewBox="0 0 200 16" preserveAspectRatio="none" className={styles.whisker} aria-hidden="true">
      <line x1={0} x2={200} y1={8} y2={8} className={styles.rail} />
      <line x1={200 * low} x2={200 * high} y1={8} y2={8} className={styles.reach} />
      <rect x={200 * value - 2} y={2} width={4} height={12} className={styles.here} />
    </svg>
  );
}

const kTone: Record<string, 'good' | 'bad' | 'neutral'> = { strength: 'good', weakness: 'bad' };

const kVerdicts: Readonly<Record<string, string>> = {
  strength: marked('strength'),
  weakness: marked('weakness'),
};

/** Correct answers by scenario, each with its interval. */
export function ByScenario({ trainee }: { readonly trainee: Trainee }) {
  return (
    <Scroll label={say('Correct answers by scenario')}>
      <table className={styles.table}>
        <caption className="hidden-visually">{say('Correct answers by scenario')}</caption>
        <thead>
          <tr>
            <th scope="col">{say('Scenario')}</th>
            <th scope="col" className={styles.number}>
              {say('Correct')}
            </th>
            <th scope="col">{say('Share with 95 % interval')}</th>
            <th scope="col">{say('Assessment')}</th>
          </tr>
        </thead>
        <tbody>
          {trainee.scenarios.map((one) => (
            <tr key={one.scenario}>
              <th scope="row">{one.scenario}</th>
              <td className={styles.number}>
                {say('{right} of {trials}', { right: formatCount(one.right), trials: formatCount(one.trials) })}
              </td>
              <td>
                {one.share === undefined ? (
                  kNone
                ) : (
                  <span className={styles.interval}>
                    <Whisker value={one.share} low={one.wilson_low ?? 0} high={one.wilson_high ?? 1} />
                    <span>
                      {formatShare(one.share)} ({one.wilson_low === undefined ? '' : formatShare(one.wilson_low)}–
                      {one.wilson_high === undefined ? '' : formatShare(one.wilson_high)})
                    </span>
                  </span>
                )}
              </td>
              <td>
                <Badge tone={kTone[one.verdict] ?? 'neutral'}>{say(kVerdicts[one.verdict] ?? one.verdict)}</Badge>
              </td>
            </tr>
          ))}
        </tbody>
      </table>
    </Scroll>
  );
}

/** Stated confidence against the share of correct answers. */
export function Calibration({ bins }: { readonly bins: readonly CalibrationBin[] }) {
  if (bins.length === 0) return <p className={styles.muted}>{say('The answers contain no confidence.')}</p>;
  const summary = bins
    .map((bin) =>
      say('stated {stated}: {right} of {trials} correct', {
        stated: formatShare(bin.stated),
        right: formatCount(bin.right),
        trials: formatCount(bin.trials),
      }),
    )
    .join('; ');
  return (
    <Plane
      across={{ title: say('stated confidence, %'), from: 40, to: 100 }}
      up={{ title: say('correct, %'), from: 0, to: 100 }}
      height_px={230}
      summary={say('Calibration of confidence: {summary}.', { summary })}
      data={{
        name: 'calibration of confidence',
        columns: ['stated_confidence', 'correct', 'trials', 'wilson_low', 'wilson_high'],
        rows: bins.map((bin) => [bin.stated, bin.right, bin.trials, bin.wilson_low, bin.wilson_high]),
      }}
    >
      {(places) => (
        <>
          <line x1={places.x(40)} y1={places.y(40)} x2={places.x(100)} y2={places.y(100)} className={styles.diagonal} />
          {bins.map((bin) => {
            const x = places.x(Math.max(40, 100 * bin.stated));
            return (
              <g key={bin.low} className={styles.bin}>
                <line x1={x} x2={x} y1={places.y(100 * bin.wilson_low)} y2={places.y(100 * bin.wilson_high)} />
                <circle
                  cx={x}
                  cy={places.y((100 * bin.right) / bin.trials)}
                  r={4 + Math.min(6, Math.sqrt(bin.trials))}
                />
                <text x={x + 10} y={places.y((100 * bin.right) / bin.trials) - 8}>
                  {formatCount(bin.trials)}
                </text>
              </g>
            );
          })}
        </>
      )}
    </Plane>
  );
}
