import type { PlannedTract } from '@/api';
import { curve, Plane } from '@/charts';
import { Table } from '@/ui';
import { formatLength, kNone, metre } from '@/units';
import styles from './cases.module.css';

const kSides = ['medial', 'lateral', 'superior', 'inferior'] as const;
const kMost_mm = 12;
const mm = (value: number) => value * 1000;

const inner = (found: PlannedTract) =>
  found.walls.map((one) => ({ ...one, breached: found.breach?.wall === one.wall }));

/** Thickness of the bone on every side along the tract, and the breach. */
export function Walls({ found }: { readonly found: PlannedTract }) {
  const sides = found.walls.filter(({ wall }) => wall !== 'anterior');
  const length_mm = mm(found.length_m);
  const thickest = Math.max(2, ...sides.flatMap(({ thickness_m }) => thickness_m.map((value) => mm(value ?? 0))));
  const top = Math.min(Math.ceil(thickest), kMost_mm);
  const { breach } = found;
  const finding = breach
    ? `The ${breach.wall} wall is breached at a depth of ${formatLength(breach.at_m)}, where it is ${formatLength(breach.wall_thickness_m)} thick.`
    : 'No wall is breached.';
  return (
    <div className={styles.stack}>
      <Plane
        across={{ title: 'depth along the tract, mm', from: 0, to: Math.max(length_mm, 1) }}
        up={{ title: 'wall thickness, mm', from: 0, to: top }}
        height_px={230}
        data={{
          name: 'wall thickness',
          columns: ['wall', 'depth_m', 'thickness_m'],
          rows: sides.flatMap(({ wall, depth_m, thickness_m }) =>
            depth_m.map((at, i) => [wall, at, thickness_m[i] ?? null]),
          ),
        }}
        summary={`Thickness of the walls along the tract. ${finding} The table lists the thinnest point of each wall.`}
      >
        {(places) => (
          <g className={styles.walls}>
            {sides.map(({ wall, depth_m, thickness_m }) => (
              <path
                key={wall}
                data-wall={wall}
                d={curve(
                  depth_m.map((at, i) => [mm(at), Math.min(mm(thickness_m[i] ?? Number.NaN), top)] as const),
                  places,
                )}
              />
            ))}
            {breach && breach.wall !== 'anterior' ? (
              <g className={styles.hole}>
                <line
                  x1={places.x(mm(breach.at_m))}
                  x2={places.x(mm(breach.at_m))}
                  y1={places.y(0)}
                  y2={places.y(top)}
                />
                <circle
                  cx={places.x(mm(breach.at_m))}
                  cy={places.y(Math.min(mm(breach.wall_thickness_m), top))}
                  r={5}
                />
              </g>
            ) : null}
          </g>
        )}
      </Plane>
      <ul className={styles.legend} aria-hidden="true">
        {kSides.map((wall) => (
          <li key={wall} data-wall={wall}>
            {wall}
          </li>
        ))}
      </ul>
      <Table
        caption="Thinnest point of each wall"
        rows={inner(found)}
        keyOf={({ wall }) => wall}
        empty=""
        minWidth={420}
        columns={[
          {
            name: 'Wall',
            cell: ({ wall, breached }) => (
              <span data-part="wall-name">
                {wall}
                {breached ? ', breached' : ''}
              </span>
            ),
          },
          {
            name: 'Thickness',
            cell: ({ thinnest }) => (thinnest ? formatLength(metre(thinnest.thickness_m)) : kNone),
            number: true,
          },
          {
            name: 'Depth',
            cell: ({ thinnest }) => (thinnest ? formatLength(metre(thinnest.at_m)) : kNone),
            number: true,
          },
          {
            name: 'Distance from the axis',
            cell: ({ thinnest }) => (thinnest ? formatLength(metre(thinnest.inner_m)) : kNone),
            number: true,
          },
        ]}
      />
    </div>
  );
}
