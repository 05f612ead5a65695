import type { ReactNode } from 'react';
import { Link } from 'wouter';
import { say } from '@/language';
import styles from './tabbed-page.module.css';
import { useTitle } from './title';

export interface PageTab {
  readonly to: string;
  /** Title of the page. */
  readonly name: string;
  /** On its tab; the title where missing. */
  readonly tab?: string;
}

/** One of several pages that belong together: its title, a sentence, and tabs that lead to the others. */
export function TabbedPage({
  tabs,
  at,
  label,
  lead,
  onPaper = 'all',
  children,
}: {
  readonly tabs: readonly PageTab[];
  /** Address of the page that is shown. */
  readonly at: string;
  /** What the tabs are called. */
  readonly label: string;
  readonly lead: string;
  /** What is printed. */
  readonly onPaper?: 'all' | 'content';
  readonly children: ReactNode;
}) {
  const here = say(tabs.find(({ to }) => to === at)?.name ?? '');
  useTitle(here);
  return (
    <div className={styles.page} data-on-paper={onPaper}>
      <div className={styles.head}>
        <h1>{here}</h1>
        <p className={styles.lead}>{lead}</p>
      </div>
      {tabs.length > 1 ? (
        <nav aria-label={label} className={styles.tabs}>
          {tabs.map(({ to, name, tab }) => (
            <Link key={to} href={to} aria-current={to === at ? 'page' : undefined}>
              {say(tab ?? name)}
            </Link>
          ))}
        </nav>
      ) : null}
      {children}
    </div>
  );
}
