import { useId, useState, type KeyboardEvent, type ReactNode } from 'react';
import styles from './term.module.css';

/** A word with its definition, shown on hover and on focus, closed by Escape. */
export function Term({ children, definition }: { readonly children: ReactNode; readonly definition: ReactNode }) {
  const id = useId();
  const [closed, setClosed] = useState(false);
  const onKeyDown = (event: KeyboardEvent) => { if (event.key === 'Escape') setClosed(true); };
  return (
    <span className={styles.holder} data-closed={closed || undefined} onPointerEnter={() => setClosed(false)}>
      <button type="button" className={styles.term} aria-describedby={id} onKeyDown={onKeyDown} onFocus={() => setClosed(false)}>
        {children}
      </button>
      <span id={id} role="tooltip" className={styles.definition}>{definition}</span>
    </span>
  );
}
