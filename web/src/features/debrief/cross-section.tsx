/** The section across the tract where the channel reaches farthest beyond the cortex. */
import * as v from 'valibot';
import type { Trial } from '@/api';
import { say } from '@/language';
import { Card } from '@/ui';
import { formatLength, metre } from '@/units';
import styles from './rating.module.css';

const point = v.tuple([v.number(), v.number()]);
const worstSchema = v.object({
  depth_m: v.number(),
  beyond_m: v.number(),
  cortex_m: point,
  farthest_m: point,
  outline_m: v.array(point),
  centre_m: point,
  radius_m: v.number(),
});
const detailSchema = v.object({ channel: v.object({ worst: worstSchema }) });
type Worst = v.InferOutput<typeof worstSchema>;

/** Of the trial's last drilling; null for a trial that did not drill, or of a station that did not measure it. */
export function worstSection(events: Trial['events']): Worst | null {
  const detail = events.findLast(({ kind }) => kind === 'drilled')?.detail;
  const read = v.safeParse(detailSchema, detail);
  return read.success ? read.output.channel.worst : null;
}

const kScale_mm = 5;
const mm = (value_m: number) => value_m * 1000;

/** Drawn in millimetres, as seen along the tract from its entry: medial to the right, superior up. */
function Section({ of, summary }: { readonly of: Worst; readonly summary: string }) {
  const corners = [...of.outline_m, of.farthest_m].flat().map((one) => Math.abs(mm(one)));
  const reach = Math.max(mm(of.radius_m), ...corners) * 1.25 + 1;
  const text = reach / 12,
    line = reach / 120;
  const place = ([x, y]: readonly [number, number]) => `${mm(x)},${-mm(y)}`;
  const sides = [
    { name: 'medial', x: reach - text / 2, y: -text / 2, anchor: 'end' },
    { name: 'lateral', x: -reach + text / 2, y: -text / 2, anchor: 'start' },
    { name: 'superior', x: 0, y: -reach + text * 1.2, anchor: 'middle' },
    { name: 'inferior', x: 0, y: reach - text * 0.6, anchor: 'middle' },
  ] as const;
  return (
    <svg viewBox={`${-reach} ${-reach} ${2 * reach} ${2 * reach}`} role="img" aria-label={summary}>
      <polygon className={styles.cortex} points={of.outline_m.map(place).join(' ')} strokeWidth={line * 1.5} />
      <circle
        className={styles.channel}
        cx={mm(of.centre_m[0])}
        cy={-mm(of.centre_m[1])}
        r={mm(of.radius_m)}
        strokeWidth={line}
      />
      <line
        className={of.beyond_m > 0 ? styles.beyond : styles.within}
        x1={mm(of.cortex_m[0])}
        y1={-mm(of.cortex_m[1])}
        x2={mm(of.farthest_m[0])}
        y2={-mm(of.farthest_m[1])}
        strokeWidth={line * 3}
      />
      <g className={styles.side} fontSize={text} aria-hidden="true">
        {sides.map(({ name, x, y, anchor }) => (
          <text key={name} x={x} y={y} textAnchor={anchor}>
            {name}
          </text>
        ))}
      </g>
      <g className={styles.scale} fontSize={text * 0.8} aria-hidden="true">
        <line
          x1={-reach + text / 2}
          x2={-reach + text / 2 + kScale_mm}
          y1={reach - text / 2}
          y2={reach - text / 2}
          strokeWidth={line * 2}
        />
        <text x={-reach + text / 2} y={reach - text * 0.9}>
          {`${kScale_mm} mm`}
        </text>
      </g>
    </svg>
  );
}

/** The surgeon's grade of a drilled channel with its picture. */
export function BreachCard({ trial }: { readonly trial: Trial }) {
  const worst = worstSection(trial.events);
  const metric = trial.metrics.find(({ id }) => id === 'breach_class');
  if (!worst || !metric || metric.value === null) return null;
  const by = formatLength(metre(Math.abs(worst.beyond_m)), 1);
  const depth = formatLength(metre(worst.depth_m), 0);
  const summary =
    worst.beyond_m > 0
      ? say('Section across the tract at a depth of {depth}: the channel reaches {by} beyond the cortex.', {
          depth,
          by,
        })
      : say('Section across the tract at a depth of {depth}: the channel stays {by} within the cortex.', { depth, by });
  return (
    <Card title={say('Breach of the cortex')}>
      <figure className={styles.section}>
        <Section of={worst} summary={summary} />
        <figcaption>
          <p>
            <strong>{say('Gertzbein-Robbins {note}.', { note: metric.note })}</strong>
          </p>
          <p>{summary}</p>
          <p className={styles.muted}>
            {say(
              'The line goes from the outer face of the cortex, as the image shows the bone before the drilling, to the farthest point of the channel’s surface. The circle is as large as the channel there. Classes: A no breach, B below 2 mm, C 2 to below 4 mm, D 4 to below 6 mm, E 6 mm or more.',
            )}
          </p>
        </figcaption>
      </figure>
    </Card>
  );
}
