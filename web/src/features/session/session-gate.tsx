import { useQuery, useQueryClient } from '@tanstack/react-query';
import { useEffect, type ReactNode } from 'react';
import { sessionQuery } from '@/api';
import { Notice } from '@/ui';
import { noteSession } from './ended';
import { FirstPassword } from './own-account-page';
import { SignIn } from './sign-in';

/** Shows the pages to who is signed in and the sign-in to all others, at the address they came for. */
export function SessionGate({ waiting, children }: { readonly waiting: ReactNode; readonly children: ReactNode }) {
  const client = useQueryClient();
  const session = useQuery(sessionQuery);
  const signedOut = session.data === null;

  useEffect(() => {
    if (session.data) noteSession();
    // What the last person saw is not kept for the next one.
    if (signedOut) client.removeQueries({ type: 'inactive' });
  }, [client, session.data, signedOut]);

  if (session.isPending) return waiting;
  if (session.data) return session.data.must_change ? <FirstPassword /> : children;
  if (session.isError) {
    return (
      <Notice tone="bad" title="The server cannot be reached." onRetry={() => void session.refetch()}>
        {session.error.message}
      </Notice>
    );
  }
  return <SignIn />;
}
