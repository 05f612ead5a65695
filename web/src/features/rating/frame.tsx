import type { ReactNode } from 'react';
import { TabbedPage } from '@/ui';

const kTabs = [
  { to: '/ratings', name: 'Ratings', tab: 'To rate' },
  { to: '/ratings/rubrics', name: 'Rubrics' },
  { to: '/ratings/agreement', name: 'Agreement of raters', tab: 'Agreement' },
] as const;

/** What the pages of ratings have in common. */
export const Frame = ({
  at,
  lead,
  children,
}: {
  readonly at: (typeof kTabs)[number]['to'];
  readonly lead: string;
  readonly children: ReactNode;
}) => (
  <TabbedPage tabs={kTabs} at={at} label="Ratings" lead={lead}>
    {children}
  </TabbedPage>
);
