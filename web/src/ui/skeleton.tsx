import type { CSSProperties } from 'react';
import styles from './skeleton.module.css';

/** Holds the place of what is coming, in its size, so that nothing jumps when it comes. */
export function Skeleton({
  width = '100%',
  height = '1em',
}: {
  readonly width?: CSSProperties['width'];
  readonly height?: CSSProperties['height'];
}) {
  return <span className={styles.skeleton} style={{ width, height }} aria-hidden="true" />;
}
