import type { ReactNode } from 'react';
import { marked, say } from '@/language';
import { TabbedPage } from '@/ui';

const kTabs = [
  { to: '/ratings', name: marked('Ratings'), tab: marked('To rate') },
  { to: '/ratings/rubrics', name: marked('Rubrics') },
  { to: '/ratings/agreement', name: marked('Agreement of raters'), tab: marked('Agreement') },
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
  <TabbedPage tabs={kTabs} at={at} label={say('Ratings')} lead={lead}>
    {children}
  </TabbedPage>
);
