import { useQuery } from '@tanstack/react-query';
import { Link } from 'wouter';
import { apiTokensQuery } from '@/api';
import { say } from '@/language';
import { Card, Notice, useTitle } from '@/ui';
import { NewToken } from './new-token';
import { TokenTable } from './token-table';
import styles from './tokens.module.css';

/** The signed-in person's API tokens. */
export function OwnTokensPage() {
  useTitle(say('API tokens'));
  const query = useQuery(apiTokensQuery);
  return (
    <div className={styles.page}>
      <div>
        <h1>{say('API tokens')}</h1>
        <p className={styles.lead}>
          {say('With a token your scripts call the server for you, within the token’s scopes and your role.')}{' '}
          <Link href="/guide/scripts">{say('Examples with curl, Python and R')}</Link>
        </p>
      </div>
      {query.isError ? (
        <Notice tone="bad" title={say('The tokens could not be loaded.')} onRetry={() => void query.refetch()}>
          {query.error.message}
        </Notice>
      ) : null}
      {query.data ? ( // both cards at once, so that neither pushes the other down
        <>
          <NewToken offered={query.data.scopes} />
          <Card title={say('Your tokens')}>
            <TokenTable tokens={query.data.tokens} empty={say('You have no tokens.')} />
          </Card>
        </>
      ) : null}
    </div>
  );
}
