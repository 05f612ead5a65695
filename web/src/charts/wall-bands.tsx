import { say } from '@/language';
import { formatCount, formatFigure, formatLength, metre, type Metre } from '@/units';
import { kHeatLevels, kSides, type Side } from './coverage';
import styles from './wall-map.module.css';

/** How well a breach can be told along one side; null where none was tried. */
export interface SideBands {
  readonly side: Side;
  readonly at_m: readonly number[];
  readonly dPrime: readonly (number | null)[];
}

interface Props {
  readonly bands: readonly SideBands[];
  readonly length_m: Metre;
  /** What a side must reach: shown as the scale's middle. */
  readonly least: number;
}

const kCell_m = 0.001;

/** 0 where nothing can be told or was tried, 1…5 up to twice of what is asked. */
export function bandLevel(dPrime: number | null, least: number): number {
  if (dPrime === null || dPrime <= 0) return 0;
  return Math.min(kHeatLevels, Math.ceil((dPrime / (2 * least)) * kHeatLevels));
}

const best = (one: SideBands | undefined) =>
  one?.dPrime.reduce<number | null>((most, d) => (d !== null && (most === null || d > most) ? d : most), null) ?? null;

const words = (d: number | null) => (d === null ? say('not tried') : `d′ ${formatFigure(d, '', 2)}`);

/** The tract unrolled, mouth at the top: how well a breach at each depth of each side could be told. */
export function WallBands({ bands, length_m, least }: Props) {
  const of = (side: Side) => bands.find((one) => one.side === side);
  const cells = Math.max(1, Math.ceil(length_m / kCell_m));
  const summary = say('Tract unrolled. Best places: {places}; {least} is asked for.', {
    places: kSides.map((side) => `${say(side)} ${words(best(of(side)))}`).join(', '),
    least: formatCount(least),
  });
  return (
    <figure className={styles.figure}>
      <div className={styles.heads}>
        {kSides.map((side) => (
          <div key={side}>
            {say(side)}
            <span className={styles.share} data-side={side}>
              {words(best(of(side)))}
            </span>
          </div>
        ))}
      </div>
      <div className={styles.plot}>
        <div className={styles.depth} aria-hidden="true">
          <span>{formatLength(metre(0), 0)}</span>
          <span>{say('depth')}</span>
          <span>{formatLength(length_m, 0)}</span>
        </div>
        <svg
          viewBox={`0 0 ${kSides.length} ${cells}`}
          preserveAspectRatio="none"
          role="img"
          aria-label={summary}
          className={styles.map}
        >
          {kSides.flatMap((side, column) =>
            (of(side)?.at_m ?? []).map((at_m, n) => {
              const dPrime = of(side)?.dPrime[n] ?? null;
              return (
                <rect
                  key={`${side} ${at_m}`}
                  x={column}
                  y={at_m / kCell_m - 0.5}
                  width={1}
                  height={1}
                  className={styles.cell}
                  data-heat={bandLevel(dPrime, least)}
                >
                  <title>
                    {say('{side}, {depth} deep: {words}', {
                      side: say(side),
                      depth: formatLength(metre(at_m)),
                      words: words(dPrime),
                    })}
                  </title>
                </rect>
              );
            }),
          )}
          {[1, 2, 3].map((x) => (
            <line key={x} x1={x} x2={x} y1={0} y2={cells} className={styles.divide} />
          ))}
        </svg>
      </div>
      <figcaption className={styles.caption}>
        <span className={styles.scale}>
          {say('cannot be told')}{' '}
          {Array.from({ length: kHeatLevels + 1 }, (_, level) => (
            <i key={level} data-heat={level} />
          ))}{' '}
          {say('d′ {value} and more', { value: formatCount(2 * least) })}
        </span>
      </figcaption>
    </figure>
  );
}
