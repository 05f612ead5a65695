/** What is drawn over a slice. Each part is drawn anew only when it changes: a pointer on its way changes the brush alone. */
import { memo } from 'react';
import type { CutLine } from './mesh-cut';
import type { Vec3 } from './scene/types';
import {
  discRadius_m,
  onSlice,
  type SliceBall,
  type SliceBrush,
  type SliceMark,
  type SlicePicture,
} from './slice-places';
import styles from './slice-view.module.css';

const kFar_m = 0.003; // farther from the plane than this, a mark is a shadow

/** A hundredth of the picture, in its pixels. */
const scaleOf = ({ width, height }: SlicePicture) => Math.max(width, height) / 100;
const hundredths = (value: number) => Math.round(value * 100) / 100;

export const Marks = memo(function Marks({
  marks,
  chosen,
  picture,
}: {
  readonly marks: readonly SliceMark[];
  readonly chosen: string;
  readonly picture: SlicePicture;
}) {
  const scale = scaleOf(picture);
  return marks.map((mark) => {
    const here = onSlice(picture, mark.at),
      there = mark.to ? onSlice(picture, mark.to) : null;
    const far = Math.abs(here.off_m) > kFar_m;
    return there ? (
      <line
        key={mark.id}
        className={styles[mark.look]}
        x1={here.x}
        y1={here.y}
        x2={there.x}
        y2={there.y}
        strokeWidth={(mark.wide ?? 0.6) * scale}
      />
    ) : (
      <g
        key={mark.id}
        className={styles[mark.look]}
        data-mark={mark.fixed ? undefined : mark.id}
        data-far={far || undefined}
        data-chosen={mark.id === chosen || undefined}
      >
        <circle className={styles.grip} cx={here.x} cy={here.y} r={3.4 * scale} />
        <circle className={styles.dot} cx={here.x} cy={here.y} r={1.5 * scale} strokeWidth={0.6 * scale} />
        {mark.text === undefined ? null : (
          <text x={here.x + 2.6 * scale} y={here.y - 2 * scale} fontSize={4.2 * scale} strokeWidth={0.9 * scale}>
            {mark.text}
          </text>
        )}
      </g>
    );
  });
});

function pathOf(picture: SlicePicture, line: CutLine): string {
  return line
    .map((p, i) => {
      const { x, y } = onSlice(picture, p);
      return `${i === 0 ? 'M' : 'L'}${hundredths(x)} ${hundredths(y)}`;
    })
    .join('');
}

/** Dashes on a dark band: seen on black, grey and white, and unlike the walls' lines without colour too. */
export const Outline = memo(function Outline({
  lines,
  picture,
}: {
  readonly lines: readonly CutLine[];
  readonly picture: SlicePicture;
}) {
  if (lines.length === 0) return null;
  const path = lines.map((line) => pathOf(picture, line)).join('');
  const scale = scaleOf(picture);
  return (
    <g className={styles.outline} data-part="outline">
      <path className={styles.band} d={path} strokeWidth={1.3 * scale} />
      <path d={path} strokeWidth={0.6 * scale} strokeDasharray={`${2 * scale} ${1.1 * scale}`} />
    </g>
  );
});

/** Where a slice cuts the balls, each with its sign in the middle. */
export const Balls = memo(function Balls({
  balls,
  picture,
}: {
  readonly balls: readonly SliceBall[];
  readonly picture: SlicePicture;
}) {
  const scale = scaleOf(picture);
  return balls.map(({ at, radius_m, sign }, i) => {
    const { x, y, off_m } = onSlice(picture, at);
    const radius = discRadius_m(radius_m, off_m) / picture.spacing_m[0];
    const arm = Math.min(radius * 0.6, 1.4 * scale);
    return radius === 0 ? null : (
      <g key={i} className={styles.ball} data-sign={sign}>
        <circle cx={x} cy={y} r={radius} strokeWidth={0.3 * scale} />
        <path
          d={`M${x - arm} ${y}h${2 * arm}${sign === '+' ? `M${x} ${y - arm}v${2 * arm}` : ''}`}
          strokeWidth={0.6 * scale}
        />
      </g>
    );
  });
});

/** The brush under the pointer, and where the keys have it; the latter is seen while keys are used. */
export function BrushRings({
  brush,
  hover,
  picture,
}: {
  readonly brush: SliceBrush;
  readonly hover: Vec3 | null;
  readonly picture: SlicePicture;
}) {
  const scale = scaleOf(picture);
  const radius = brush.radius_m / picture.spacing_m[0];
  const ring = (at: Vec3, name: string | undefined) => {
    const { x, y } = onSlice(picture, at);
    return (
      <g className={name} data-sign={brush.sign}>
        <circle cx={x} cy={y} r={radius} strokeWidth={0.5 * scale} />
        <path d={`M${x - scale} ${y}h${2 * scale}M${x} ${y - scale}v${2 * scale}`} strokeWidth={0.3 * scale} />
      </g>
    );
  };
  return (
    <>
      {hover ? ring(hover, styles.ring) : null}
      {ring(brush.cursor, `${styles.ring ?? ''} ${styles.cursor ?? ''}`)}
    </>
  );
}
