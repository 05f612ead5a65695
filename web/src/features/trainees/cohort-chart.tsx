import type { CohortProgress } from '@/api';
import { curve, Plane } from '@/charts';
import { say } from '@/language';
import { formatCount, formatShare } from '@/units';
import styles from './trainees.module.css';

const kColours = 5;

type Bin = CohortProgress['bins'][number];

/** The middle of a bin of trials; curves stand a little beside one another, so that each interval is seen. */
const middle = ({ from, to }: Bin, i: number, of: number) => (from + to) / 2 + 0.4 * (i - (of - 1) / 2);

/** The learning curve of each cohort: correct answers by running trial number, with intervals over trainees. */
export function CohortChart({ cohorts }: { readonly cohorts: readonly CohortProgress[] }) {
  const shown = cohorts.filter(({ bins }) => bins.length > 0);
  const last = shown.reduce((most, { bins }) => Math.max(most, bins.at(-1)?.to ?? 0), 5);
  return (
    <>
      <Plane
        across={{ title: say('running trial number'), from: 0, to: last }}
        up={{ title: say('correct answers, %'), from: 0, to: 100 }}
        height_px={300}
        summary={`${say('Share of correct answers by running trial number.')} ${shown
          .map(({ name, bins }) => {
            const now = bins.at(-1);
            return now
              ? say('{name}: {share} at trials {from} to {to}.', {
                  name,
                  share: formatShare(now.share),
                  from: formatCount(now.from),
                  to: formatCount(now.to),
                })
              : '';
          })
          .join(' ')}`}
        data={{
          name: 'correct answers by cohort',
          columns: ['cohort', 'first_trial', 'last_trial', 'trainees', 'share', 'ci95_low', 'ci95_high'],
          rows: shown.flatMap(({ name, bins }) =>
            bins.map(({ from, to, trainees, share, low, high }) => [name, from, to, trainees, share, low, high]),
          ),
        }}
      >
        {(places) => (
          <>
            {shown.map(({ id, bins }, i) => {
              const at = (bin: Bin) => places.x(middle(bin, i, shown.length));
              return (
                <g key={id} className={styles.cohort} data-series={i % kColours}>
                  {bins.map((bin) =>
                    bin.low === null || bin.high === null ? null : (
                      <line
                        key={bin.from}
                        x1={at(bin)}
                        x2={at(bin)}
                        y1={places.y(100 * bin.low)}
                        y2={places.y(100 * bin.high)}
                      />
                    ),
                  )}
                  <path
                    d={curve(
                      bins.map((bin) => [middle(bin, i, shown.length), 100 * bin.share] as const),
                      places,
                    )}
                  />
                  {bins.map((bin) => (
                    <circle key={bin.from} cx={at(bin)} cy={places.y(100 * bin.share)} r={4} />
                  ))}
                </g>
              );
            })}
          </>
        )}
      </Plane>
      <ul className={styles.key}>
        {shown.map(({ id, name }, i) => (
          <li key={id}>
            <i data-series={i % kColours} />
            {name}
          </li>
        ))}
      </ul>
      <p className={styles.muted}>
        {say('Means over trainees in steps of five trials; lines: 95 % intervals of the mean over trainees.')}
      </p>
    </>
  );
}
