import { useId, type PointerEvent } from 'react';
import { say } from '@/language';
import { viridis } from './colour';
import styles from './painted-wall.module.css';

export interface WallCell {
  readonly depth_m: number;
  readonly angle_rad: number;
  readonly value: number | null;
}

interface Props {
  /** Edges, from the mouth inwards. */
  readonly depth_m: readonly number[];
  /** Edges round the axis. */
  readonly angle_rad: readonly number[];
  /** [depth][angle]; null where nothing touched. */
  readonly values: readonly (readonly (number | null)[])[];
  readonly format: (value: number) => string;
  readonly onPoint: (cell: WallCell | null) => void;
}

export const largestOf = (values: Props['values']) =>
  values.flat().reduce<number>((top, value) => Math.max(top, value ?? 0), 0);
export const paint = (value: number, most: number) =>
  `rgb(${viridis(most > 0 ? value / most : 0)
    .map((c) => Math.round(c * 255))
    .join(' ')})`;

/** A value on the wall of a tract, unrolled: mouth at the top, once round from left to right. */
export function PaintedWall({ depth_m, angle_rad, values, format, onPoint }: Props) {
  const id = useId();
  const rows = depth_m.length - 1,
    columns = angle_rad.length - 1;
  const most = largestOf(values);
  const cellAt = (event: PointerEvent<SVGSVGElement>): WallCell => {
    const box = event.currentTarget.getBoundingClientRect();
    const column = Math.min(Math.max(Math.floor(((event.clientX - box.left) / box.width) * columns), 0), columns - 1);
    const row = Math.min(Math.max(Math.floor(((event.clientY - box.top) / box.height) * rows), 0), rows - 1);
    return {
      depth_m: ((depth_m[row] ?? 0) + (depth_m[row + 1] ?? 0)) / 2,
      angle_rad: ((angle_rad[column] ?? 0) + (angle_rad[column + 1] ?? 0)) / 2,
      value: values[row]?.[column] ?? null,
    };
  };
  const flat = values.flatMap((row, r) => row.map((value, c) => ({ r, c, value })));
  const worst = flat.reduce(
    (top, cell) => ((cell.value ?? -1) > (top.value ?? -1) ? cell : top),
    flat[0] ?? { r: 0, c: 0, value: null },
  );
  const mm = (m: number | undefined) => `${Math.round((m ?? 0) * 1000)} mm`;
  return (
    <figure className={styles.figure}>
      <div className={styles.plot}>
        <div className={styles.depth} aria-hidden="true">
          <span>{mm(depth_m[0])}</span>
          <span>{say('depth')}</span>
          <span>{mm(depth_m.at(-1))}</span>
        </div>
        <svg
          viewBox={`0 0 ${columns} ${rows}`}
          preserveAspectRatio="none"
          role="img"
          aria-labelledby={id}
          className={styles.map}
          onPointerMove={(event) => onPoint(cellAt(event))}
          onPointerLeave={() => onPoint(null)}
        >
          <title id={id}>
            {worst.value === null
              ? say('Unrolled wall of the tract, without a value.')
              : say('Unrolled wall of the tract. Largest value: {value} at {from} to {to}.', {
                  value: format(worst.value),
                  from: mm(depth_m[worst.r]),
                  to: mm(depth_m[worst.r + 1]),
                })}
          </title>
          {flat.map(({ r, c, value }) =>
            value === null ? null : (
              <rect key={`${r} ${c}`} x={c} y={r} width={1.02} height={1.02} fill={paint(value, most)} />
            ),
          )}
        </svg>
        <div />
        <div className={styles.angle} aria-hidden="true">
          {[0, 90, 180, 270, 360].map((degrees) => (
            <span key={degrees}>{degrees}°</span>
          ))}
        </div>
      </div>
      <figcaption className={styles.caption}>
        <span className={styles.scale}>
          0{' '}
          <i
            style={{
              background: `linear-gradient(to right, ${[0, 0.25, 0.5, 0.75, 1].map((share) => paint(share, 1)).join(', ')})`,
            }}
          />{' '}
          {format(most)}
        </span>
        <span>{say('empty: not touched')}</span>
      </figcaption>
    </figure>
  );
}
