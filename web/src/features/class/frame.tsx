import type { ReactNode } from 'react';
import { TabbedPage } from '@/ui';

const kTabs = [
  { to: '/class', name: 'Import a class' },
  { to: '/class/change', name: 'Change accounts' },
  { to: '/class/groups', name: 'Groups of the provider' },
] as const;

/** What the pages of a class have in common; cards are printed without it. */
export const Frame = ({
  at,
  lead,
  children,
}: {
  readonly at: (typeof kTabs)[number]['to'];
  readonly lead: string;
  readonly children: ReactNode;
}) => (
  <TabbedPage tabs={kTabs} at={at} label="Class" lead={lead} onPaper="content">
    {children}
  </TabbedPage>
);
