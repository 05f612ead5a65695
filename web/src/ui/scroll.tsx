import type { ReactNode } from 'react';
import styles from './table.module.css';

interface Props {
  readonly label: string;
  readonly children: ReactNode;
  readonly className?: string | undefined;
}

/** Content that may be wider than the page; it scrolls by itself, also with the keyboard. */
export function Scroll({ label, children, className = '' }: Props) {
  return (
    // eslint-disable-next-line jsx-a11y/no-noninteractive-tabindex -- a part that scrolls takes the keys that scroll it
    <div className={`${styles.frame} ${className}`} role="group" aria-label={label} tabIndex={0}>
      {children}
    </div>
  );
}
