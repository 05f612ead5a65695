import { useId, type ReactNode } from 'react';
import styles from './card.module.css';

interface Props {
  readonly title: string;
  /** Right of the title: buttons, a badge. */
  readonly aside?: ReactNode;
  readonly children: ReactNode;
  readonly className?: string;
}

/** A titled part of a page, a landmark of its own. */
export function Card({ title, aside, children, className }: Props) {
  const id = useId();
  return (
    <section className={[styles.card, className].filter(Boolean).join(' ')} aria-labelledby={id}>
      <div className={styles.head}>
        <h2 id={id}>{title}</h2>
        {aside}
      </div>
      {children}
    </section>
  );
}
