import type { ScenarioCheck } from '@/api';
import { curve, Plane } from '@/charts';
import { say } from '@/language';
import { formatCount, formatForce, kSpeed, newton, withUnit } from '@/units';
import styles from './scenarios.module.css';

const kSurgeon_N = 150;

/** The force that the law requires over depth, computed by the code that runs at the station. */
export function Resistance({
  found,
  late,
}: {
  readonly found: NonNullable<ScenarioCheck['curve']>;
  readonly late: boolean;
}) {
  const mm = found.depth_m.map((depth) => depth * 1000);
  const end = mm.at(-1) ?? 1;
  const peak = found.at.reduce((most, { force_N }) => force_N.reduce((high, force) => Math.max(high, force), most), 0);
  const top = Math.max(peak, kSurgeon_N) * 1.08;
  return (
    <div className={styles.resistance} data-part="resistance" data-late={late || undefined}>
      <Plane
        across={{ title: say('tip depth, mm'), from: 0, to: end }}
        up={{ title: say('required force, N'), from: 0, to: top }}
        height_px={340}
        data={{
          name: 'resistance',
          columns: ['depth_m', ...found.at.map(({ speed_m_s }) => `force_N_at_${speed_m_s}_m_s`)],
          rows: found.depth_m.map((depth_m, row) => [depth_m, ...found.at.map(({ force_N }) => force_N[row] ?? null)]),
        }}
        summary={say('Required force over depth at {count} speeds, up to {force}; {walls}.', {
          count: formatCount(found.at.length),
          force: formatForce(newton(peak)),
          walls:
            found.walls.length === 0
              ? say('no wall')
              : say('walls at {depths}', {
                  depths: found.walls.map(({ at_m }) => `${Math.round(at_m * 1e4) / 10} mm`).join(', '),
                }),
        })}
      >
        {(places) => (
          <g>
            {found.layers.map(({ from_m, to_m }, i) =>
              i % 2 ? null : (
                <rect
                  key={from_m}
                  className={styles.layer}
                  x={places.x(from_m * 1000)}
                  width={Math.max(0, places.x(to_m * 1000) - places.x(from_m * 1000))}
                  y={places.y(top)}
                  height={places.height_px}
                />
              ),
            )}
            {found.walls.map(({ from_m, at_m, to_m }) => (
              <g key={at_m}>
                <rect
                  className={styles.before}
                  x={places.x(from_m * 1000)}
                  width={places.x(at_m * 1000) - places.x(from_m * 1000)}
                  y={places.y(top)}
                  height={places.height_px}
                />
                <rect
                  className={styles.behind}
                  x={places.x(at_m * 1000)}
                  width={Math.max(0, places.x(Math.min(to_m * 1000, end)) - places.x(at_m * 1000))}
                  y={places.y(top)}
                  height={places.height_px}
                />
              </g>
            ))}
            <line
              className={styles.surgeon}
              x1={places.x(0)}
              x2={places.x(end)}
              y1={places.y(kSurgeon_N)}
              y2={places.y(kSurgeon_N)}
            />
            <text className={styles.note} x={places.x(0) + 6} y={places.y(kSurgeon_N) - 5}>
              {say('typical force of a surgeon')}
            </text>
            {found.at.map(({ speed_m_s, force_N }, k) => (
              <path
                key={speed_m_s}
                className={styles.push}
                data-speed={k}
                d={curve(
                  force_N.map((force, i) => [mm[i] ?? 0, force] as const),
                  places,
                )}
              />
            ))}
          </g>
        )}
      </Plane>
      <ul className={styles.legend}>
        {found.at.map(({ speed_m_s }, k) => (
          <li key={speed_m_s} data-speed={k}>
            {say('at {speed}', { speed: withUnit(speed_m_s, kSpeed, 0) })}
          </li>
        ))}
        <li data-band="before">{say('increasing resistance')}</li>
        <li data-band="behind">{say('soft tissue behind a wall')}</li>
      </ul>
    </div>
  );
}
