import { useMutation, useQuery, useQueryClient } from '@tanstack/react-query';
import { Link } from 'wouter';
import { ApiError, sessionQuery, signOut } from '@/api';
import { say, speak } from '@/language';
import { Button, roleName } from '@/ui';
import { sessionLanguage } from './account-language';
import styles from './account.module.css';
import { noteSignOut } from './ended';

export function Account() {
  const client = useQueryClient();
  const session = useQuery({ ...sessionQuery, enabled: false });
  const leave = useMutation({
    // A session that the server has ended already is as good as one that it ends now.
    mutationFn: () =>
      signOut().catch((reason: unknown) => {
        if (!(reason instanceof ApiError && reason.code === 'unauthorised')) throw reason;
      }),
    onSuccess: () => {
      noteSignOut();
      client.setQueryData(sessionQuery.queryKey, null);
      speak(sessionLanguage(client)).catch(() => undefined);
    },
  });
  if (!session.data) return null;
  return (
    <>
      {leave.isError ? (
        <span role="alert" className={styles.failed}>
          {say('Signing out failed: {message}', { message: leave.error.message })}
        </span>
      ) : null}
      <Link href="/account" className={styles.who}>
        {session.data.name} <span className={styles.role}>{roleName(session.data.role)}</span>
      </Link>
      <Button onClick={() => leave.mutate()} disabled={leave.isPending}>
        {say('Sign out')}
      </Button>
    </>
  );
}
