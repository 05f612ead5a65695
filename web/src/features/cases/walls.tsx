import type { PlannedTract } from '@/api';
import { curve, Plane } from '@/charts';
import { say } from '@/language';
import { Table, wallName } from '@/ui';
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
    ? say('The {wall} wall is breached at a depth of {at}, where it is {thickness} thick.', {
        wall: wallName(breach.wall),
        at: formatLength(breach.at_m),
        thickness: formatLength(breach.wall_thickness_m),
      })
    : say('No wall is breached.');
  return (
    <div className={styles.stack}>
      <Plane
        across={{ title: say('depth along the tract, mm'), from: 0, to: Math.max(length_mm, 1) }}
        up={{ title: say('wall thickness, mm'), from: 0, to: top }}
        height_px={230}
        data={{
          name: 'wall thickness',
          columns: ['wall', 'depth_m', 'thickness_m'],
          rows: sides.flatMap(({ wall, depth_m, thickness_m }) =>
            depth_m.map((at, i) => [wall, at, thickness_m[i] ?? null]),
          ),
        }}
        summary={say(
          'Thickness of the walls along the tract. {finding} The table lists the thinnest point of each wall.',
          { finding },
        )}
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
            {wallName(wall)}
          </li>
        ))}
      </ul>
      <Table
        caption={say('Thinnest point of each wall')}
        rows={inner(found)}
        keyOf={({ wall }) => wall}
        empty=""
        minWidth={420}
        columns={[
          {
            name: say('Wall'),
            cell: ({ wall, breached }) => (
              <span data-part="wall-name">
                {breached ? say('{wall}, breached', { wall: wallName(wall) }) : wallName(wall)}
              </span>
            ),
          },
          {
            name: say('Thickness'),
            cell: ({ thinnest }) => (thinnest ? formatLength(metre(thinnest.thickness_m)) : kNone),
            number: true,
          },
          {
            name: say('Depth'),
            cell: ({ thinnest }) => (thinnest ? formatLength(metre(thinnest.at_m)) : kNone),
            number: true,
          },
          {
            name: say('Distance from the axis'),
            cell: ({ thinnest }) => (thinnest ? formatLength(metre(thinnest.inner_m)) : kNone),
            number: true,
          },
        ]}
      />
    </div>
  );
}
