import { useMutation, useQuery, useQueryClient } from '@tanstack/react-query';
import { useState, type FormEvent } from 'react';
import { recordStoreQuery, removeRecordStore, setRecordStore } from '@/api';
import { say } from '@/language';
import { AskDialog, Button, Card, Facts, Field, Notice } from '@/ui';
import { formatDateTime } from '@/units';
import styles from './notifications.module.css';

const useFreshStore = () => {
  const client = useQueryClient();
  return () => client.invalidateQueries({ queryKey: recordStoreQuery.queryKey });
};

function NewStore() {
  const fresh = useFreshStore();
  const [endpoint, setEndpoint] = useState('');
  const [key, setKey] = useState('');
  const [secret, setSecret] = useState('');
  const set = useMutation({ mutationFn: setRecordStore, onSuccess: fresh });
  const submit = (event: FormEvent) => {
    event.preventDefault();
    set.mutate({ endpoint: endpoint.trim(), key: key.trim(), secret });
  };
  return (
    <form className={styles.form} onSubmit={submit}>
      <Field
        label={say('Endpoint (https)')}
        type="url"
        required
        value={endpoint}
        onChange={({ target }) => setEndpoint(target.value)}
      />
      <Field label={say('Key')} required value={key} onChange={({ target }) => setKey(target.value)} />
      <Field
        label={say('Secret')}
        type="password"
        autoComplete="off"
        required
        value={secret}
        onChange={({ target }) => setSecret(target.value)}
      />
      <Button look="solid" type="submit" disabled={set.isPending}>
        {say('Send statements there')}
      </Button>
      {set.isError ? (
        <Notice tone="bad" title={say('The record store was not set.')}>
          {set.error.message}
        </Notice>
      ) : null}
    </form>
  );
}

/** The learning record store: stated, removed. */
export function RecordStoreCard() {
  const fresh = useFreshStore();
  const query = useQuery(recordStoreQuery);
  const [asked, setAsked] = useState(false);
  const removed = useMutation({ mutationFn: removeRecordStore, onSuccess: fresh });
  const store = query.data?.store;
  return (
    <Card title={say('Learning record store')}>
      <div className={styles.stack}>
        <p className={styles.muted}>
          {say(
            'Statements (xAPI 1.0.3) of trials received from now on, once their results are released, of people who consented to the tier metrics, by pseudonym.',
          )}
        </p>
        {query.isError ? (
          <Notice tone="bad" title={say('The record store could not be loaded.')} onRetry={() => void query.refetch()}>
            {query.error.message}
          </Notice>
        ) : null}
        {store ? (
          <>
            <Facts
              facts={[
                { name: say('Address of the record store'), value: store.endpoint },
                { name: say('Key'), value: store.key },
                { name: say('Added'), value: formatDateTime(store.made_utc_us) },
              ]}
            />
            <span className={styles.buttons}>
              <Button label={say('Remove {name}', { name: store.endpoint })} onClick={() => setAsked(true)}>
                {say('Remove')}
              </Button>
            </span>
          </>
        ) : null}
        {query.data && !store ? <NewStore /> : null}
      </div>
      {asked && store ? (
        <AskDialog
          title={say('Remove the learning record store?')}
          action={say('Remove')}
          onAction={() => removed.mutateAsync()}
          onClose={() => setAsked(false)}
        >
          <p>{say('No statements are sent any more. What waits is withdrawn; what was sent stays there.')}</p>
        </AskDialog>
      ) : null}
    </Card>
  );
}
