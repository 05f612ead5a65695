import styles from './progress.module.css';

/** How much of a whole is done; the words beside it say the numbers. */
export function Progress({ done, of, label }: { readonly done: number; readonly of: number; readonly label: string }) {
  return <progress className={styles.progress} value={done} max={Math.max(of, 1)} aria-label={label} />;
}
