import type { ReactNode } from 'react';
import { marked, say } from '@/language';
import { TabbedPage } from '@/ui';

const kTabs = [
  { to: '/curricula', name: marked('Curricula') },
  { to: '/criteria', name: marked('Criteria') },
] as const;

/** What the lists of curricula and criteria have in common. */
export const Frame = ({
  at,
  lead,
  children,
}: {
  readonly at: (typeof kTabs)[number]['to'];
  readonly lead: string;
  readonly children: ReactNode;
}) => (
  <TabbedPage tabs={kTabs} at={at} label={say('Passing')} lead={lead}>
    {children}
  </TabbedPage>
);
