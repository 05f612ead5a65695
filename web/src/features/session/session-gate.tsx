import { useQuery, useQueryClient } from '@tanstack/react-query';
import { lazy, Suspense, useEffect, useSyncExternalStore, type ReactNode } from 'react';
import { resumeRequests, sessionQuery } from '@/api';
import { say } from '@/language';
import { Notice } from '@/ui';
import { currentPerson, notePerson, subscribePerson } from './ended';
import { SignIn } from './sign-in';

const FirstPassword = lazy(() => import('./own-account-page').then(({ FirstPassword: page }) => ({ default: page })));

/**
 * Shows the pages to who is signed in and the sign-in to all others, at the address they came for. When a session ends by
 * itself, the page stays as it is behind the sign-in: the same person finds again what was typed, anybody else a new page.
 */
export function SessionGate({ waiting, children }: { readonly waiting: ReactNode; readonly children: ReactNode }) {
  const client = useQueryClient();
  const session = useQuery(sessionQuery);
  const person = useSyncExternalStore(subscribePerson, currentPerson);
  const name = session.data?.name ?? null;

  useEffect(() => {
    if (name !== null && name === person) resumeRequests(true);
    if (name !== null && name !== person) {
      resumeRequests(false);
      // What the last person saw is not kept for the next one.
      client.removeQueries({ predicate: ({ queryKey }) => queryKey[0] !== sessionQuery.queryKey[0] });
      notePerson(name);
    }
    if (name === null && person === null) client.removeQueries({ type: 'inactive' });
  }, [client, name, person]);

  if (session.isPending) return waiting;
  if (session.isError && !session.data && person === null) {
    return (
      <Notice tone="bad" title={say('The server cannot be reached.')} onRetry={() => void session.refetch()}>
        {session.error.message}
      </Notice>
    );
  }
  return (
    <>
      {name === null ? <SignIn /> : name === person ? null : waiting}
      {person === null ? null : (
        <div key={person} style={{ display: name === person ? 'contents' : 'none' }}>
          {session.data?.must_change ? (
            <Suspense fallback={waiting}>
              <FirstPassword />
            </Suspense>
          ) : (
            children
          )}
        </div>
      )}
    </>
  );
}
