import { scaleLinear, scaleLog } from 'd3-scale';
import { useId, useRef, type ReactNode } from 'react';
import { say } from '@/language';
import { tickLabels } from '@/units';
import { kChartFiles, saveChart, type ChartData } from './chart-files';
import { ticksOf, type Tick } from './depth-scale';
import styles from './plane.module.css';
import { useWidth } from './use-width';

/** One axis, in the unit that is shown. A logarithmic one has positive bounds. */
export interface PlaneAxis {
  readonly title: string;
  readonly from: number;
  readonly to: number;
  readonly log?: boolean;
  readonly ticks?: readonly Tick[];
}

export interface Places {
  readonly x: (value: number) => number;
  readonly y: (value: number) => number;
  readonly width_px: number;
  readonly height_px: number;
}

interface Props {
  readonly across: PlaneAxis;
  readonly up: PlaneAxis;
  readonly height_px?: number;
  /** The picture in words. */
  readonly summary: string;
  /** Offers the chart as files. */
  readonly data?: ChartData;
  readonly children: (places: Places) => ReactNode;
}

const kLeft = 50,
  kRight = 12,
  kTop = 22,
  kBottom = 36;

/** What is not positive has no place on a logarithmic axis; it lies far below. */
function placing(axis: PlaneAxis, start_px: number, end_px: number): (value: number) => number {
  const domain = [axis.from, axis.to],
    range = [start_px, end_px];
  if (!axis.log) return scaleLinear(domain, range);
  const scale = scaleLog(domain, range);
  return (value) => scale(Math.max(value, 1e-300));
}

/** Round places of an axis with their labels. */
export function ticks(axis: PlaneAxis, most: number): readonly Tick[] {
  if (axis.ticks) return axis.ticks;
  const domain = [axis.from, axis.to];
  if (!axis.log) return ticksOf(scaleLinear(domain, [0, 1]), most);
  const scale = scaleLog(domain, [0, 1]);
  const fitting = scale.tickFormat(most / 2); // empty where a label would touch its neighbour
  return scale
    .ticks(most)
    .filter((at) => fitting(at) !== '')
    .map((at) => ({ at, text: tickLabels([at], at)[0] ?? '' }));
}

/** Ticks that fit a vertical axis without crowding. */
export const mostTicks = (height_px: number) => Math.max(2, Math.floor((height_px - kTop - kBottom) / 22));

/** Two axes, and what is drawn between them: small statistics that are read, not panned. */
export function Plane({ across, up, height_px = 220, summary, data, children }: Props) {
  const place = useRef<HTMLDivElement>(null);
  const width = useWidth(place);
  const id = useId();
  const x = placing(across, kLeft, width - kRight),
    y = placing(up, height_px - kBottom, kTop);
  return (
    <figure className={styles.figure}>
      <div ref={place} className={styles.frame} style={{ minHeight: height_px }}>
        {width === 0 ? null : (
          <svg width={width} height={height_px} viewBox={`0 0 ${width} ${height_px}`} role="img" aria-labelledby={id}>
            <title id={id}>{summary}</title>
            <g className={styles.axes} aria-hidden="true">
              {ticks(up, mostTicks(height_px)).map(({ at, text }) => (
                <g key={at} transform={`translate(0 ${y(at)})`}>
                  <line x1={kLeft} x2={width - kRight} />
                  <text x={kLeft - 6} dy="0.35em" textAnchor="end">
                    {text}
                  </text>
                </g>
              ))}
              {ticks(across, Math.max(2, Math.floor(width / 90))).map(({ at, text }) => (
                <g key={at} transform={`translate(${x(at)} ${height_px - kBottom})`}>
                  <line y1={0} y2={5} />
                  <text y={17} textAnchor="middle">
                    {text}
                  </text>
                </g>
              ))}
              <text x={width - kRight} y={height_px - 4} textAnchor="end">
                {across.title}
              </text>
              <text x={0} y={12}>
                {up.title}
              </text>
            </g>
            {children({ x, y, width_px: width - kLeft - kRight, height_px: height_px - kTop - kBottom })}
          </svg>
        )}
      </div>
      {data ? (
        <div className={styles.files} role="group" aria-label={say('Download the chart: {name}', { name: data.name })}>
          {kChartFiles.map((kind) => (
            <button
              key={kind}
              type="button"
              aria-label={say('{kind} of {name}', { kind, name: data.name })}
              onClick={() => {
                const svg = place.current?.querySelector('svg');
                if (svg) void saveChart(kind, svg, data);
              }}
            >
              {kind}
            </button>
          ))}
        </div>
      ) : null}
    </figure>
  );
}

/** "M x y L …"; a point that is no number ends the stretch before it. */
export function curve(points: readonly (readonly [number, number])[], { x, y }: Places): string {
  let path = '',
    open = false;
  for (const [a, b] of points) {
    const px = x(a),
      py = y(b);
    if (!Number.isFinite(px) || !Number.isFinite(py)) {
      open = false;
      continue;
    }
    path += `${open ? 'L' : 'M'}${Math.round(px * 10) / 10} ${Math.round(py * 10) / 10}`;
    open = true;
  }
  return path;
}

/** The outline of a histogram between two bounds, down to the axis at both ends. */
export function stairs(
  edges: readonly number[],
  shares: readonly number[],
  [from, to]: readonly [number, number],
  places: Places,
): string {
  const within = (edge: number) => Math.min(Math.max(edge, from), to);
  const points: [number, number][] = [];
  shares.forEach((share, i) => {
    const low = within(edges[i] ?? 0),
      high = within(edges[i + 1] ?? 0);
    if (high > low) points.push([low, share], [high, share]);
  });
  const first = points[0],
    last = points.at(-1);
  return first && last ? curve([[first[0], 0], ...points, [last[0], 0]], places) : '';
}
