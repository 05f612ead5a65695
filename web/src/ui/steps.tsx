import { Link } from 'wouter';
import styles from './steps.module.css';

export interface StepPlace {
  readonly href: string;
  readonly name: string;
  readonly current: boolean;
  /** What is known of it already, in two words. */ readonly note?: string;
}

/** The steps of a piece of work, in order; each has an address of its own and can be gone to at any time. */
export function Steps({ label, steps }: { readonly label: string; readonly steps: readonly StepPlace[] }) {
  return (
    <nav aria-label={label} className={styles.steps}>
      <ol>
        {steps.map(({ href, name, current, note }, i) => (
          <li key={href}>
            <Link href={href} aria-current={current ? 'step' : undefined} className={styles.step}>
              <span className={styles.number} aria-hidden="true">
                {i + 1}
              </span>
              <span>
                {name}
                {note === undefined ? null : <span className={styles.note}>{note}</span>}
              </span>
            </Link>
          </li>
        ))}
      </ol>
    </nav>
  );
}
