import { useMutation, useQueryClient } from '@tanstack/react-query';
import { useState, type FormEvent } from 'react';
import {
  addWebhook,
  kWebhookKinds,
  outboxQuery,
  removeWebhook,
  testWebhook,
  type NotificationKind,
  type Webhook,
} from '@/api';
import { marked, say } from '@/language';
import { AskDialog, Button, Card, DataTable, Field, Notice } from '@/ui';
import { formatDateTime } from '@/units';
import { kKindNames } from './labels';
import styles from './notifications.module.css';

function NewWebhook() {
  const client = useQueryClient();
  const [url, setUrl] = useState('');
  const [kinds, setKinds] = useState<readonly NotificationKind[]>([]);
  const added = useMutation({
    mutationFn: addWebhook,
    onSuccess: async () => {
      setUrl('');
      setKinds([]);
      await client.invalidateQueries({ queryKey: outboxQuery.queryKey });
    },
  });
  const submit = (event: FormEvent) => {
    event.preventDefault();
    added.mutate({ url: url.trim(), kinds });
  };
  return (
    <>
      <form className={styles.form} onSubmit={submit}>
        <Field
          label={say('Address (https)')}
          type="url"
          required
          maxLength={2000}
          value={url}
          onChange={(event) => setUrl(event.target.value)}
        />
        <fieldset className={styles.kinds}>
          <legend>{say('Events')}</legend>
          {kWebhookKinds.map((kind) => (
            <label key={kind}>
              <input
                type="checkbox"
                checked={kinds.includes(kind)}
                onChange={({ target }) =>
                  setKinds(target.checked ? [...kinds, kind] : kinds.filter((one) => one !== kind))
                }
              />
              {say(kKindNames[kind])}
            </label>
          ))}
        </fieldset>
        <Button look="solid" type="submit" disabled={added.isPending || url.trim() === '' || kinds.length === 0}>
          {say('Add webhook')}
        </Button>
      </form>
      {added.isError ? (
        <Notice tone="bad" title={say('The webhook was not added.')}>
          {added.error.message}
        </Notice>
      ) : null}
      {added.data ? (
        <Notice tone="warn" title={say('Secret of the webhook')}>
          <p className={styles.secret} data-part="secret">
            {added.data.secret}
          </p>
          <p>{say('Copy the secret into the receiver now: it is shown only once.')}</p>
        </Notice>
      ) : null}
    </>
  );
}

/** Webhooks: added, tested, removed. */
export function WebhooksCard({ webhooks }: { readonly webhooks: readonly Webhook[] }) {
  const client = useQueryClient();
  const fresh = () => client.invalidateQueries({ queryKey: outboxQuery.queryKey });
  const [asked, setAsked] = useState<Webhook | null>(null);
  const tested = useMutation({ mutationFn: testWebhook, onSuccess: fresh });
  const removed = useMutation({ mutationFn: removeWebhook, onSuccess: fresh });
  return (
    <Card title={say('Webhooks')}>
      <div className={styles.stack}>
        <p className={styles.muted}>
          {say(
            'The server sends a signed request (Standard Webhooks, HMAC-SHA-256) to each address when something happens. It contains the kind of event, its time and the address of a page, no names.',
          )}
        </p>
        {tested.isError ? (
          <Notice tone="bad" title={say('The test was not queued.')}>
            {tested.error.message}
          </Notice>
        ) : null}
        <DataTable<Webhook>
          caption={say('Webhooks')}
          order={say('oldest first')}
          minWidth={640}
          rows={webhooks}
          keyOf={({ id }) => id}
          empty={say('There are no webhooks.')}
          columns={[
            { name: marked('Address'), by: (one) => one.url, cell: (one) => one.url },
            { name: marked('Events'), cell: (one) => one.kinds.map((kind) => say(kKindNames[kind])).join(', ') },
            { name: marked('Added'), by: (one) => one.made_utc_us, cell: (one) => formatDateTime(one.made_utc_us) },
            {
              name: <span className="hidden-visually">{say('Actions')}</span>,
              cell: (one) => (
                <span className={styles.buttons}>
                  <Button
                    label={say('Send a test to {url}', { url: one.url })}
                    disabled={tested.isPending}
                    onClick={() => tested.mutate(one.id)}
                  >
                    {say('Send a test')}
                  </Button>
                  <Button label={say('Remove {name}', { name: one.url })} onClick={() => setAsked(one)}>
                    {say('Remove')}
                  </Button>
                </span>
              ),
            },
          ]}
        />
        <NewWebhook />
      </div>
      {asked ? (
        <AskDialog
          title={say('Remove this webhook?')}
          action={say('Remove')}
          onAction={() => removed.mutateAsync(asked.id)}
          onClose={() => setAsked(null)}
        >
          <p>{say('{url} is no longer called. What waits for it is withdrawn.', { url: asked.url })}</p>
        </AskDialog>
      ) : null}
    </Card>
  );
}
