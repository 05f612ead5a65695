import { say } from '@/language';
import styles from './depth-chart.module.css';
import { ends, type Scale } from './depth-scale';

export interface Bone {
  readonly travel_m: number;
  readonly layers: readonly { readonly from_m: number; readonly to_m: number; readonly stiffness_N_per_m: number }[];
  /** Resistance grows from `growsFrom_m` to the wall at `at_m`; soft tissue from there to `breachTo_m`. */
  readonly walls: readonly { readonly at_m: number; readonly growsFrom_m: number; readonly breachTo_m: number }[];
}

interface Props {
  readonly bone: Bone;
  readonly across: Scale;
  readonly up: Scale;
}

/** Layers as shades by stiffness, the growing resistance before a wall, the wall, the soft tissue behind it, the probe stop. */
export function BoneBehind({ bone, across, up }: Props) {
  const stiffest = bone.layers.reduce((top, layer) => Math.max(top, layer.stiffness_N_per_m), 1);
  const [bottom, top] = ends(up);
  const height = bottom - top;
  const band = (from_m: number, to_m: number) => {
    const x = across(from_m);
    return { x, y: top, width: Math.max(across(to_m) - x, 0), height };
  };
  const stop = across(bone.travel_m);
  return (
    <g data-part="bone">
      {bone.layers.map((layer) => (
        <rect
          key={layer.from_m}
          {...band(layer.from_m, layer.to_m)}
          className={styles.layer}
          fillOpacity={0.12 + 0.5 * (layer.stiffness_N_per_m / stiffest)}
        />
      ))}
      {bone.walls.map((wall) => (
        <g key={wall.at_m} data-part="wall">
          <rect {...band(wall.growsFrom_m, wall.at_m)} className={styles.grow} />
          <rect {...band(wall.at_m, wall.breachTo_m)} className={styles.breach} />
          <line x1={across(wall.at_m)} x2={across(wall.at_m)} y1={top} y2={bottom} className={styles.wall} />
        </g>
      ))}
      <line x1={stop} x2={stop} y1={top} y2={bottom} className={styles.stop} />
      <text x={stop - 4} y={top - 6} textAnchor="end" className={styles.name}>
        {say('probe stop')}
      </text>
    </g>
  );
}
