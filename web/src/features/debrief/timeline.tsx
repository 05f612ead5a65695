import { useEffect, useRef, type PointerEvent } from 'react';
import { curve, Plane, type Cursor, type Places } from '@/charts';
import type { Scenario } from '@/api';
import { say } from '@/language';
import type { Moments, Way } from './align';
import styles from './debrief.module.css';
import type { Moment } from './marks';
import type { Player } from './use-player';

interface Props {
  readonly way: Way;
  readonly ghost: { readonly way: Way; readonly at: Moments } | null;
  readonly duration_s: number;
  readonly cursor: Cursor;
  readonly player: Player;
  readonly moments: readonly Moment[];
  /** The bone of the rig, behind the depths. */
  readonly scenario: Scenario | null;
}

/** The ends of the axis need no name. */
const kEnds: readonly string[] = ['start', 'end'];

function Playhead({ places, cursor }: { readonly places: Places; readonly cursor: Cursor }) {
  const line = useRef<SVGLineElement>(null);
  useEffect(() => {
    const follow = () => line.current?.setAttribute('transform', `translate(${places.x(cursor.now() ?? 0)} 0)`);
    follow();
    return cursor.subscribe(follow);
  });
  return <line ref={line} className={styles.head} y1={22} y2={22 + places.height_px} />;
}

/** Inside one picture of time: a click or a drag goes to the moment under the pointer. */
function useScrub(player: Player) {
  const places = useRef<Places | null>(null);
  const held = useRef(false);
  const go = (event: PointerEvent<HTMLDivElement>) => {
    const at = places.current;
    if (!at) return;
    const from = at.x(0),
      perSecond = at.x(1) - from;
    player.seek((event.clientX - event.currentTarget.getBoundingClientRect().left - from) / perSecond);
  };
  return {
    remember: (now: Places) => {
      places.current = now;
    },
    handlers: {
      onPointerDown: (event: PointerEvent<HTMLDivElement>) => {
        if (event.target instanceof Element && event.target.closest('button')) return; // a file of the chart
        held.current = true;
        event.currentTarget.setPointerCapture(event.pointerId);
        go(event);
      },
      onPointerMove: (event: PointerEvent<HTMLDivElement>) => {
        if (held.current) go(event);
      },
      onPointerUp: () => {
        held.current = false;
      },
      onPointerCancel: () => {
        held.current = false;
      },
    },
  };
}

/** The other trial's values at the moments of this one. */
function shifted(
  { way: mine, ghost }: Props,
  column: 'force_N' | 'depth_m',
  scale: number,
): (readonly [number, number])[] {
  if (!ghost) return [];
  let row = 0;
  return mine.t_s.map((t) => {
    const at = ghost.at(t);
    while (row < ghost.way.t_s.length - 1 && (ghost.way.t_s[row + 1] ?? 0) <= at) ++row;
    return [t, (ghost.way[column][row] ?? 0) * scale] as const;
  });
}

const top = (values: readonly number[], least: number) => values.reduce((most, value) => Math.max(most, value), least);

function Line(
  props: Props & {
    readonly column: 'force_N' | 'depth_m';
    readonly title: string;
    readonly scale: number;
    readonly named: boolean;
  },
) {
  const { way, ghost, duration_s, cursor, moments, scenario, column, title, scale, named } = props;
  const { remember, handlers } = useScrub(props.player);
  const most = top(way[column], 0) * scale,
    other = ghost ? top(ghost.way[column], 0) * scale : 0;
  const least = Math.min(0, way[column].reduce((low, value) => Math.min(low, value), 0) * scale);
  const bone = column === 'depth_m' ? scenario : null;
  const end = Math.max(most, other, (bone?.travel_m ?? 0) * scale, column === 'force_N' ? 0.5 : 1) * 1.05;
  return (
    <div className={styles.line} data-part={`line-${column}`} {...handlers}>
      <Plane
        across={{ title: say('time, s'), from: 0, to: Math.max(duration_s, 0.1) }}
        up={{ title, from: least, to: end }}
        height_px={170}
        data={{
          name: title,
          columns: ['t_s', column],
          rows: way.t_s.map((t, i) => [t, way[column][i] ?? null]),
        }}
        summary={
          ghost
            ? say('{title} over the trial, with the curve of the example.', { title })
            : say('{title} over the trial.', { title })
        }
      >
        {(places) => {
          remember(places);
          const across = { x: places.x(0), width: places.width_px };
          return (
            <g>
              {bone?.layers.map((layer, i) =>
                i % 2 ? null : (
                  <rect
                    key={layer.start_m}
                    className={styles.layer}
                    {...across}
                    y={places.y((layer.start_m + layer.thickness_m) * scale)}
                    height={Math.max(
                      0,
                      places.y(layer.start_m * scale) - places.y((layer.start_m + layer.thickness_m) * scale),
                    )}
                  />
                ),
              )}
              {bone?.walls.map((wall) => (
                <rect
                  key={wall.position_m}
                  className={styles.wall}
                  {...across}
                  y={places.y(wall.position_m * scale)}
                  height={Math.max(
                    1,
                    places.y((wall.position_m - wall.resistance_interval_m) * scale) -
                      places.y(wall.position_m * scale),
                  )}
                />
              ))}
              {moments.map((one, i) => (
                <g
                  key={i}
                  className={one.kind === 'comment' ? styles.comment : styles.event}
                  transform={`translate(${places.x(one.t_s)} 0)`}
                >
                  <line y1={22} y2={22 + places.height_px} />
                  {named && one.kind === 'event' && !kEnds.includes(one.text) ? (
                    <text y={19} textAnchor={one.t_s > duration_s / 2 ? 'end' : 'start'}>
                      {say(one.text)}
                    </text>
                  ) : null}
                  {one.kind === 'comment' ? <circle cy={26} r={4} /> : null}
                </g>
              ))}
              <path className={styles.ghostLine} d={curve(shifted(props, column, scale), places)} />
              <path
                className={styles.mine}
                d={curve(
                  way.t_s.map((t, i) => [t, (way[column][i] ?? 0) * scale] as const),
                  places,
                )}
              />
              <Playhead places={places} cursor={cursor} />
            </g>
          );
        }}
      </Plane>
    </div>
  );
}

/** Force and depth along time, this trial's and the example's, with the moment that is shown. */
export function Timeline(props: Props) {
  return (
    <div className={styles.stack}>
      <Line
        {...props}
        column="force_N"
        title={props.scenario ? say('hand force, N') : say('tip force, N')}
        scale={1}
        named
      />
      <Line {...props} column="depth_m" title={say('tip depth, mm')} scale={1000} named={false} />
    </div>
  );
}
