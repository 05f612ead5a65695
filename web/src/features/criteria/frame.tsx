import type { ReactNode } from 'react';
import { TabbedPage } from '@/ui';

const kTabs = [
  { to: '/curricula', name: 'Curricula' },
  { to: '/criteria', name: 'Criteria' },
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
  <TabbedPage tabs={kTabs} at={at} label="Passing" lead={lead}>
    {children}
  </TabbedPage>
);
