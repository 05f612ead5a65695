import type { ReactNode } from 'react';
import styles from './table.module.css';

/** What may be wider than the page: it scrolls by itself, with keys too. */
export function Scroll({ label, children }: { readonly label: string; readonly children: ReactNode }) {
  // eslint-disable-next-line jsx-a11y/no-noninteractive-tabindex -- a part that scrolls takes the keys that scroll it
  return <div className={styles.frame} role="group" aria-label={label} tabIndex={0}>{children}</div>;
}
