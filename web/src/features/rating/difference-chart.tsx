import type { RaterGroup } from '@/api';
import { Plane } from '@/charts';
import { say } from '@/language';
import { formatCount, formatFigure } from '@/units';
import styles from './rating.module.css';

/** Differences of two raters against their means, with the limits of agreement [Bland1986]; equal places lie as one dot. */
export function DifferenceChart({
  first,
  second,
  totals,
  differences,
}: {
  readonly first: string;
  readonly second: string;
  readonly totals: RaterGroup['totals'];
  readonly differences: NonNullable<RaterGroup['differences']>;
}) {
  const dots = totals.map(([a = 0, b = 0]) => ({ mean: (a + b) / 2, difference: a - b }));
  const means = dots.map(({ mean }) => mean),
    spans = [...dots.map(({ difference }) => difference), differences.low, differences.high, 0];
  const margin = (values: readonly number[]) => (Math.max(...values) - Math.min(...values)) * 0.08 || 1;
  const across = { from: Math.min(...means) - margin(means), to: Math.max(...means) + margin(means) };
  const up = { from: Math.min(...spans) - margin(spans), to: Math.max(...spans) + margin(spans) };
  const lines = [
    { at: differences.high, text: say('mean + 1.96 SD'), limit: true },
    { at: differences.mean, text: say('mean'), limit: false },
    { at: differences.low, text: say('mean − 1.96 SD'), limit: true },
  ];
  return (
    <Plane
      across={{ title: say('mean of both sums, points'), ...across }}
      up={{ title: say('{first} less {second}, points', { first, second }), ...up }}
      height_px={280}
      summary={say(
        '{trials} trials: the sums of {first} are {mean} points above those of {second} on average; 95 % of the differences lie between {low} and {high}.',
        {
          trials: formatCount(dots.length),
          first,
          mean: formatFigure(differences.mean),
          second,
          low: formatFigure(differences.low),
          high: formatFigure(differences.high),
        },
      )}
      data={{
        name: `agreement of ${first} and ${second}`,
        columns: [`sum_${first}`, `sum_${second}`],
        rows: totals.map(([a = 0, b = 0]) => [a, b]),
      }}
    >
      {({ x, y }) => (
        <>
          <g className={styles.limits}>
            {lines.map(({ at, text, limit }) => (
              <g key={text}>
                <line
                  className={limit ? styles.limit : undefined}
                  x1={x(across.from)}
                  x2={x(across.to)}
                  y1={y(at)}
                  y2={y(at)}
                />
                <text x={x(across.to) - 4} y={y(at) - 4} textAnchor="end">
                  {text}: {formatFigure(at)}
                </text>
              </g>
            ))}
          </g>
          <g className={styles.trials}>
            {dots.map(({ mean, difference }, i) => (
              <circle key={i} cx={x(mean)} cy={y(difference)} r={4} />
            ))}
          </g>
        </>
      )}
    </Plane>
  );
}
