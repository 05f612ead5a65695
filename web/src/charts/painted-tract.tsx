import { useEffect, useRef, useState } from 'react';
import { say } from '@/language';
import { viridis } from './colour';
import { largestOf } from './painted-wall';
import type { PaintedScene } from './scene/painted';
import styles from './tract-view.module.css';
import { turnByKey, useResized } from './turning';

interface Props {
  readonly depth_m: readonly number[];
  readonly angle_rad: readonly number[];
  readonly values: readonly (readonly (number | null)[])[];
  readonly radius_m: number;
  readonly summary: string;
}

const kUntouched = [150, 156, 166] as const;

/** The wall of a tract with a value painted on it, to be turned about; entry at the top. */
export function PaintedTract({ depth_m, angle_rad, values, radius_m, summary }: Props) {
  const canvas = useRef<HTMLDivElement>(null);
  const [scene, setScene] = useState<PaintedScene | null>(null);
  const [failed, setFailed] = useState(false);
  useEffect(() => {
    const place = canvas.current;
    if (!place) return;
    let gone = false;
    let made: PaintedScene | null = null;
    const most = largestOf(values);
    const colours = values.map((row) =>
      row.map((value) => {
        if (value === null) return kUntouched;
        const [r, g, b] = viridis(most > 0 ? value / most : 0);
        return [255 * r, 255 * g, 255 * b] as const;
      }),
    );
    import('./scene/painted')
      .then(({ makePainted }) => {
        if (gone) return;
        made = makePainted(place, { depth_m, angle_rad, colours, radius_m });
        setScene(made);
      })
      .catch(() => setFailed(true));
    return () => {
      gone = true;
      made?.destroy();
      setScene(null);
    };
  }, [depth_m, angle_rad, values, radius_m]);
  useResized(scene, canvas);
  return (
    <figure className={styles.figure}>
      {/* eslint-disable-next-line jsx-a11y/no-noninteractive-element-interactions -- an application takes keys */}
      <div
        className={`${styles.stage} ${styles.small}`}
        role="application"
        aria-roledescription={say('3-D picture')}
        aria-label={summary}
        data-part="painted"
        data-ready={scene !== null || undefined}
        // eslint-disable-next-line jsx-a11y/no-noninteractive-tabindex -- an application takes keys
        tabIndex={0}
        onKeyDown={(event) => turnByKey(event, scene, () => scene?.reset())}
      >
        <div ref={canvas} className={styles.canvas} hidden={failed} />
        {failed ? (
          <p className={styles.failure} role="alert">
            {say('The 3-D view could not be drawn. The unrolled map shows the same values.')}
          </p>
        ) : scene === null ? (
          <p className={styles.failure} role="status">
            {say('Drawing…')}
          </p>
        ) : null}
      </div>
      <figcaption className={styles.caption}>
        <span>{say('entry at the top')}</span>
        <span className={styles.hint}>{say('Drag or use the arrow keys to rotate.')}</span>
      </figcaption>
    </figure>
  );
}
