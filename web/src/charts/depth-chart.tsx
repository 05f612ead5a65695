import { scaleLinear } from 'd3-scale';
import { useId, useMemo, useRef, useSyncExternalStore, type PointerEvent } from 'react';
import { say } from '@/language';
import { axisTitle, formatForce, formatLength, kForce, kLength, metre, newton } from '@/units';
import type { Cursor } from './cursor';
import { BoneBehind, type Bone } from './depth-bone';
import styles from './depth-chart.module.css';
import { ends, linePath, nearestPoint, ticksOf, type Scale } from './depth-scale';
import { lowerBound } from './tiles';
import { useWidth } from './use-width';

interface Props {
  readonly t_s: readonly number[];
  readonly depth_m: readonly number[];
  readonly force_N: readonly number[];
  /** null where it may not be known. */
  readonly bone: Bone | null;
  /** Where a breach was reported. */
  readonly felt_m: number | null;
  readonly cursor: Cursor;
}

export const kDepthHeight_px = 300;
const kLeft = 54,
  kRight = 12,
  kTop = 22,
  kBottom = 34;

const most = (values: readonly number[], least: number) => values.reduce((top, value) => Math.max(top, value), least);

function scales(
  { depth_m, force_N, bone }: Pick<Props, 'depth_m' | 'force_N' | 'bone'>,
  width: number,
): { across: Scale; up: Scale } {
  const deepest = Math.max(bone?.travel_m ?? 0, most(depth_m, 0.001));
  const shallowest = Math.min(0, ...depth_m.slice(0, 1));
  const strongest = most(force_N, 1) * 1.08;
  const weakest =
    -most(
      force_N.map((force) => -force),
      0,
    ) * 1.08;
  return {
    across: scaleLinear([shallowest, deepest * 1.02], [kLeft, width - kRight]),
    up: scaleLinear([weakest, strongest], [kDepthHeight_px - kBottom, kTop]),
  };
}

function Axes({ across, up }: { readonly across: Scale; readonly up: Scale }) {
  const [left, right] = ends(across);
  const [bottom] = ends(up);
  const mm = across.copy().domain(across.domain().map((depth_m) => depth_m * kLength.perSi));
  return (
    <g className={styles.axes}>
      {ticksOf(up, 6).map(({ at, text }) => (
        <g key={at} transform={`translate(0 ${up(at)})`}>
          <line x1={left} x2={right} />
          <text x={left - 6} dy="0.35em" textAnchor="end">
            {text}
          </text>
        </g>
      ))}
      {ticksOf(mm, Math.max(2, (right - left) / 80)).map(({ at, text }) => (
        <g key={at} transform={`translate(${mm(at)} ${bottom})`}>
          <line y1={0} y2={5} />
          <text y={18} textAnchor="middle">
            {text}
          </text>
        </g>
      ))}
      <text x={right} y={kDepthHeight_px - 2} textAnchor="end">
        {axisTitle(say('Depth'), kLength)}
      </text>
    </g>
  );
}

/** The moment under the pointer, wherever on the page it is pointed at. */
function Here({ props, across, up }: { readonly props: Props; readonly across: Scale; readonly up: Scale }) {
  const { t_s, depth_m, force_N, cursor } = props;
  const moment = useSyncExternalStore(cursor.subscribe, cursor.now);
  if (moment === null || t_s.length === 0) return null;
  const i = Math.min(lowerBound(t_s, moment), t_s.length - 1);
  const x = across(depth_m[i] ?? 0),
    y = up(force_N[i] ?? 0);
  const [left] = ends(across);
  const [bottom, top] = ends(up);
  const reading = say('{force} at {depth}', {
    force: formatForce(newton(force_N[i] ?? 0)),
    depth: formatLength(metre(depth_m[i] ?? 0)),
  });
  return (
    <g className={styles.here}>
      <line x1={x} x2={x} y1={top} y2={bottom} />
      <circle cx={x} cy={y} r={5} />
      <text x={left + 4} y={14}>
        {reading}
      </text>
    </g>
  );
}

function summary({ depth_m, force_N, bone, felt_m }: Props): string {
  const strongest = most(force_N, 0);
  const at = depth_m[force_N.indexOf(strongest)] ?? 0;
  const walls = bone?.walls.map((wall) => formatLength(metre(wall.at_m))).join(', ') ?? '';
  return [
    say('Force against depth: up to {force} at {depth}, maximum depth {deepest}.', {
      force: formatForce(newton(strongest)),
      depth: formatLength(metre(at)),
      deepest: formatLength(metre(most(depth_m, 0))),
    }),
    bone === null
      ? ''
      : walls === ''
        ? say('No wall is breached.')
        : say('Walls are breached at {depths}.', { depths: walls }),
    felt_m === null ? '' : say('A breach was reported at {depth}.', { depth: formatLength(metre(felt_m)) }),
  ]
    .filter(Boolean)
    .join(' ');
}

/** Push against depth, with the layers and walls of the bone behind the curve. */
export function DepthChart(props: Props) {
  const { t_s, depth_m, force_N, bone, felt_m, cursor } = props;
  const place = useRef<HTMLDivElement>(null);
  const width = useWidth(place);
  const summaryId = useId();
  const { across, up } = useMemo(
    () => scales({ depth_m, force_N, bone }, Math.max(width, 200)),
    [depth_m, force_N, bone, width],
  );
  const [bottom, top] = ends(up);
  const path = useMemo(() => linePath(depth_m, force_N, across, up), [depth_m, force_N, across, up]);
  const point = (event: PointerEvent<SVGSVGElement>) => {
    const box = event.currentTarget.getBoundingClientRect();
    const i = nearestPoint(depth_m, force_N, across, up, event.clientX - box.left, event.clientY - box.top);
    cursor.set(t_s[i] ?? null);
  };
  return (
    <figure className={styles.figure} aria-describedby={summaryId}>
      <div ref={place} style={{ minHeight: kDepthHeight_px }} data-part="depth-chart">
        {width === 0 ? null : (
          <svg
            width={width}
            height={kDepthHeight_px}
            role="img"
            aria-labelledby={summaryId}
            onPointerMove={point}
            onPointerLeave={() => cursor.set(null)}
          >
            {bone ? <BoneBehind bone={bone} across={across} up={up} /> : null}
            <Axes across={across} up={up} />
            <path d={path} className={styles.curve} data-part="depth-curve" />
            {felt_m === null ? null : (
              <g className={styles.felt} transform={`translate(${across(felt_m)} 0)`}>
                <line y1={top} y2={bottom} />
                <path d={`M-6 ${top - 10}h12l-6 9z`} />
              </g>
            )}
            <Here props={props} across={across} up={up} />
          </svg>
        )}
      </div>
      <ul className={styles.key}>
        <li>
          <i className={styles.curveKey} />
          {axisTitle(say('hand force'), kForce)}
        </li>
        {bone ? (
          <li>
            <i className={styles.layerKey} />
            {say('layers, darker when stiffer')}
          </li>
        ) : null}
        {bone && bone.walls.length > 0 ? (
          <>
            <li>
              <i className={styles.growKey} />
              {say('increasing resistance')}
            </li>
            <li>
              <i className={styles.breachKey} />
              {say('soft tissue behind the wall')}
            </li>
          </>
        ) : null}
        {felt_m === null ? null : (
          <li>
            <i className={styles.feltKey} />
            {say('breach reported here')}
          </li>
        )}
      </ul>
      <p id={summaryId} className={styles.summary}>
        {summary(props)}
      </p>
    </figure>
  );
}
