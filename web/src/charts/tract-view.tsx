import { useEffect, useMemo, useState } from 'react';
import { say } from '@/language';
import { formatForce, newton } from '@/units';
import { viridis } from './colour';
import type { Cursor } from './cursor';
import type { Scene } from './scene';
import type { SceneBone, ScenePath, SceneTract } from './scene/types';
import { Stage, type StageProps } from './stage';
import styles from './tract-view.module.css';

interface Props extends Pick<StageProps, 'palette' | 'summary' | 'button'> {
  readonly tract: SceneTract;
  readonly path: ScenePath;
  /** null where the bone could not be fetched: the rest is drawn without it. */
  readonly bone: SceneBone | null;
  readonly cursor: Cursor;
  /** Another trial on the same case, and its moment that goes with a moment of this one. */
  readonly ghost?: { readonly path: ScenePath; readonly at: (t_s: number) => number } | null;
}

const kColours = { bone: '--bone', tract: '--accent', moment: '--series-across', ghost: '--event' } as const;
const kScale = `linear-gradient(to right, ${Array.from(
  { length: 9 },
  (_, i) =>
    `rgb(${viridis(i / 8)
      .map((c) => Math.round(c * 255))
      .join(' ')})`,
).join(', ')})`;

/** Top of the colour scale: above all but the strongest twentieth, so that a few taps do not darken the rest. */
function topOf(force_N: readonly number[]): number {
  const sorted = [...force_N].sort((a, b) => a - b);
  return Math.max(sorted[Math.floor(0.95 * (sorted.length - 1))] ?? 0, 0.05);
}

/** The tract, the bone round it and the way of the tip, to be turned about. */
export function TractView({ tract, path, bone, cursor, ghost = null, palette, summary, button }: Props) {
  const [scene, setScene] = useState<Scene | null>(null);
  const most_N = topOf(path.force_N);
  const ghostPath = ghost?.path ?? null,
    ghostAt = ghost?.at ?? null;
  const content = useMemo(
    () => ({ tract, path, bone, most_N, ghost: ghostPath }),
    [tract, path, bone, most_N, ghostPath],
  );
  useEffect(() => {
    if (!scene) return;
    const follow = () => {
      const now = cursor.now();
      scene.moment(now);
      scene.ghost(now === null || !ghostAt ? null : ghostAt(now));
    };
    follow();
    return cursor.subscribe(follow);
  }, [scene, cursor, ghostAt]);
  const scale = (
    <span className={styles.scale}>
      {say('tip force')} 0<i style={{ background: kScale }} />
      {say('{force} and above', { force: formatForce(newton(most_N)) })}
    </span>
  );
  return (
    <Stage
      content={content}
      colours={kColours}
      palette={palette}
      label={say('View of the tract')}
      summary={summary}
      button={button}
      caption={scale}
      onScene={setScene}
    />
  );
}
