import { useQuery } from '@tanstack/react-query';
import type { ReactNode } from 'react';
import { sessionQuery } from '@/api';
import { marked, say } from '@/language';
import { TabbedPage } from '@/ui';

const kTabs = [
  { to: '/class', name: marked('Import a class'), roles: ['admin', 'director'] },
  { to: '/class/change', name: marked('Change accounts'), roles: ['admin'] },
  { to: '/class/groups', name: marked('Groups of the provider'), roles: ['admin'] },
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
}) => {
  const role = useQuery({ ...sessionQuery, enabled: false }).data?.role ?? '';
  const tabs = kTabs.filter(({ to, roles }) => to === at || (roles as readonly string[]).includes(role));
  return (
    <TabbedPage tabs={tabs} at={at} label={say('Class')} lead={lead} onPaper="content">
      {children}
    </TabbedPage>
  );
};
