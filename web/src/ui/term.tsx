import { useId, useState, type KeyboardEvent, type ReactNode } from 'react';
import styles from './term.module.css';

interface Props {
  readonly children: ReactNode;
  readonly definition: ReactNode;
  /** Which side the definition is flush with: the end, for words near the right edge. */
  readonly align?: 'start' | 'end';
}

/** A word with its definition, shown on hover and on focus, closed by Escape. */
export function Term({ children, definition, align = 'start' }: Props) {
  const id = useId();
  const [closed, setClosed] = useState(false);
  const onKeyDown = (event: KeyboardEvent) => {
    if (event.key === 'Escape') setClosed(true);
  };
  return (
    <span
      className={`${styles.holder} ${align === 'end' ? styles.end : ''}`}
      data-closed={closed || undefined}
      onPointerEnter={() => setClosed(false)}
    >
      <button
        type="button"
        className={styles.term}
        aria-describedby={id}
        onKeyDown={onKeyDown}
        onFocus={() => setClosed(false)}
      >
        {children}
      </button>
      <span id={id} role="tooltip" className={styles.definition}>
        {definition}
      </span>
    </span>
  );
}
