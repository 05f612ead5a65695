import type { ReactNode } from 'react';
import { Link } from 'wouter';
import { useTitle } from '@/ui';
import styles from './class.module.css';

const kTabs = [
  { to: '/class', name: 'Import a class' },
  { to: '/class/change', name: 'Change accounts' },
] as const;

/** What stands round the pages of a class. */
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
      <div className={styles.screen}>
        <h1>{here}</h1>
        <p className={styles.lead}>{lead}</p>
      </div>
      <nav aria-label="Class" className={`${styles.tabs} ${styles.screen}`}>
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
