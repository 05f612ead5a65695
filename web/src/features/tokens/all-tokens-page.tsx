import { useQuery } from '@tanstack/react-query';
import { Link } from 'wouter';
import { allApiTokensQuery } from '@/api';
import { say } from '@/language';
import { Card, Notice, useTitle } from '@/ui';
import { TokenTable } from './token-table';
import styles from './tokens.module.css';

/** Every valid token, for administrators. */
export function AllTokensPage() {
  useTitle(say('API tokens of all accounts'));
  const query = useQuery(allApiTokensQuery);
  return (
    <div className={styles.page}>
      <div>
        <h1>{say('API tokens of all accounts')}</h1>
        <p className={styles.lead}>
          {say('Each token acts for its owner, within its scopes and the owner’s role.')}{' '}
          <Link href="/network/people">{say('Accounts')}</Link>
        </p>
      </div>
      {query.isError ? (
        <Notice tone="bad" title={say('The tokens could not be loaded.')} onRetry={() => void query.refetch()}>
          {query.error.message}
        </Notice>
      ) : null}
      <Card title={say('Valid tokens')}>
        <TokenTable tokens={query.data?.tokens} owners empty={say('No account has a valid token.')} />
      </Card>
    </div>
  );
}
