import type { ReactNode } from 'react';
import { Link } from 'wouter';
import { useTitle } from '@/ui';
import styles from './rating.module.css';

const kTabs = [
  { to: '/ratings', name: 'Ratings', tab: 'To rate' },
  { to: '/ratings/rubrics', name: 'Rubrics', tab: 'Rubrics' },
  { to: '/ratings/agreement', name: 'Agreement of raters', tab: 'Agreement' },
] as const;

/** What stands round the pages of ratings. */
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
      <nav aria-label="Ratings" className={styles.tabs}>
        {kTabs.map(({ to, tab }) => (
          <Link key={to} href={to} aria-current={to === at ? 'page' : undefined}>
            {tab}
          </Link>
        ))}
      </nav>
      {children}
    </div>
  );
}
