import type { ReactNode } from 'react';
import { Link } from 'wouter';
import { useTitle } from '@/ui';
import styles from './criteria.module.css';

const kTabs = [
  { to: '/curricula', name: 'Curricula' },
  { to: '/criteria', name: 'Criteria' },
] as const;

/** What stands round the lists of curricula and criteria. */
export function Frame({
  at,
  lead,
  children,
}: {
  readonly at: (typeof kTabs)[number]['to'];
  readonly lead: string;
  readonly children: ReactNode;
}) {
  const here = kTabs.find(({ to }) => to === at)?.name ?? '';
  useTitle(here);
  return (
    <div className={styles.page}>
      <div>
        <h1>{here}</h1>
        <p className={styles.lead}>{lead}</p>
      </div>
      <nav aria-label="Passing" className={styles.tabs}>
        {kTabs.map(({ to, name }) => (
          <Link key={to} href={to} aria-current={to === at ? 'page' : undefined}>
            {name}
          </Link>
        ))}
      </nav>
      {children}
    </div>
  );
}
