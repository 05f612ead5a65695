import styles from './bar.module.css';

interface Props {
  readonly share: number;
  readonly tone?: 'accent' | 'bad' | 'good' | 'muted';
  readonly label?: string;
}

/** A share of a whole as a bar; the number stands beside it. */
export function Bar({ share, tone = 'accent', label }: Props) {
  const width = `${Math.min(Math.max(Number.isFinite(share) ? share : 0, 0), 1) * 100}%`;
  return (
    <span
      className={`${styles.bar} ${styles[tone]}`}
      {...(label === undefined ? { 'aria-hidden': true } : { role: 'img', 'aria-label': label })}
    >
      <i style={{ width }} />
    </span>
  );
}
