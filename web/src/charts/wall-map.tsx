import { useState, useSyncExternalStore, type PointerEvent } from 'react';
import { say } from '@/language';
import { formatCount, formatLength, formatShare, metre, share, type Metre } from '@/units';
import { binOf, coveredBySide, heatPaths, kHeatLevels, kSides, sideOf, type Side, type WallBins } from './coverage';
import type { Cursor } from './cursor';
import styles from './wall-map.module.css';

interface Props {
  readonly bins: WallBins;
  readonly length_m: Metre;
  /** The side of the breach, where it may be known. */
  readonly breached?: Side | undefined;
  /** How deep the tip was at a moment, null where that is not known. */
  readonly depthAt: (t_s: number) => number | null;
  readonly cursor: Cursor;
}

const kInitial: Record<Side, string> = { medial: 'M', superior: 'S', lateral: 'L', inferior: 'I' };

/** How deep the tip was at the moment under the pointer. */
function Here({ bins, length_m, depthAt, cursor }: Props) {
  const moment = useSyncExternalStore(cursor.subscribe, cursor.now);
  const depth_m = moment === null ? null : depthAt(moment);
  if (depth_m === null || depth_m < 0 || depth_m > length_m) return null;
  const y = (depth_m / length_m) * bins.depthBins;
  return <line x1={0} x2={bins.angleBins} y1={y} y2={y} className={styles.here} />;
}

/** The wall unrolled, mouth at the top, with what share of each side was touched. */
export function WallMap(props: Props) {
  const { bins, length_m, breached } = props;
  const { depthBins, angleBins, samples } = bins;
  const [pointed, setPointed] = useState('');
  const sides = coveredBySide(bins);
  const ofSide = (side: Side) => share(sides[side].bins > 0 ? sides[side].touched / sides[side].bins : 0);
  const onPointerMove = (event: PointerEvent<SVGSVGElement>) => {
    const box = event.currentTarget.getBoundingClientRect();
    const column = Math.min(Math.floor(((event.clientX - box.left) / box.width) * angleBins), angleBins - 1);
    const row = Math.min(Math.floor(((event.clientY - box.top) / box.height) * depthBins), depthBins - 1);
    const angle = binOf(column, angleBins);
    const depth = metre(((row + 0.5) / depthBins) * length_m);
    setPointed(
      say('{side}, {depth} deep: {samples} samples in contact', {
        side: say(sideOf(angle, angleBins)),
        depth: formatLength(depth),
        samples: formatCount(samples[row * angleBins + angle] ?? 0),
      }),
    );
  };
  const summary = say('Wall of the tract unrolled. Touched: {sides}.', {
    sides: kSides.map((side) => `${say(side)} ${formatShare(ofSide(side))}`).join(', '),
  });
  return (
    <figure className={styles.figure}>
      <div className={styles.heads}>
        {kSides.map((side) => (
          <div key={side} className={side === breached ? styles.breached : undefined}>
            <strong aria-hidden="true">{kInitial[side]}</strong> {say(side)}
            <span className={styles.share} data-side={side}>
              {formatShare(ofSide(side))}
            </span>
            {side === breached ? <span className={styles.tag}>{say('breached here')}</span> : null}
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
          viewBox={`0 0 ${angleBins} ${depthBins}`}
          preserveAspectRatio="none"
          role="img"
          aria-label={summary}
          className={styles.map}
          onPointerMove={onPointerMove}
          onPointerLeave={() => setPointed('')}
        >
          {heatPaths(bins).map((path, level) => (
            <path key={level} d={path} className={styles.cell} data-heat={level} />
          ))}
          {[1, 2, 3].map((quarter) => (
            <line
              key={quarter}
              x1={(quarter * angleBins) / 4}
              x2={(quarter * angleBins) / 4}
              y1={0}
              y2={depthBins}
              className={styles.divide}
            />
          ))}
          <Here {...props} />
        </svg>
      </div>
      <figcaption className={styles.caption}>
        <span className={styles.scale}>
          {say('not touched')}{' '}
          {Array.from({ length: kHeatLevels + 1 }, (_, level) => (
            <i key={level} data-heat={level} />
          ))}{' '}
          {say('longest contact')}
        </span>
        <span className={styles.pointed}>{pointed}</span>
      </figcaption>
    </figure>
  );
}
