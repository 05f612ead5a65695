import type { ReactNode } from 'react';
import { say } from '@/language';
import { Button } from './button';
import styles from './notice.module.css';

interface Props {
  readonly tone?: 'info' | 'bad' | 'warn';
  readonly title: string;
  readonly children?: ReactNode;
  readonly onRetry?: (() => void) | undefined;
}

/** Something that a person must know: what happened, and what can be done. */
export function Notice({ tone = 'info', title, children, onRetry }: Props) {
  return (
    <div className={`${styles.notice} ${styles[tone]}`} role={tone === 'bad' ? 'alert' : 'status'}>
      <p className={styles.title}>{title}</p>
      {children === undefined ? null : <div className={styles.text}>{children}</div>}
      {onRetry ? <Button onClick={onRetry}>{say('Try again')}</Button> : null}
    </div>
  );
}
