import { useMutation, useQuery, useQueryClient } from '@tanstack/react-query';
import { useState, type FormEvent } from 'react';
import {
  ownNotificationsQuery,
  setNotifications,
  testNotification,
  type NotificationDelivery,
  type OwnNotifications,
} from '@/api';
import { marked, say } from '@/language';
import { Button, Card, Field, Notice, Select, useTitle } from '@/ui';
import styles from './notifications.module.css';

const kDeliveries: readonly { readonly value: NotificationDelivery; readonly text: string }[] = [
  { value: 'off', text: marked('Off') },
  { value: 'immediate', text: marked('At once') },
  { value: 'daily', text: marked('Once a day') },
];

function Choices({ now }: { readonly now: OwnNotifications }) {
  const client = useQueryClient();
  const [address, setAddress] = useState(now.address ?? '');
  const [choices, setChoices] = useState(now.choices);
  const saved = useMutation({
    mutationFn: setNotifications,
    onSuccess: (answer) => client.setQueryData(ownNotificationsQuery.queryKey, answer),
  });
  const tested = useMutation({ mutationFn: testNotification });
  const failed = saved.error ?? tested.error;
  const submit = (event: FormEvent) => {
    event.preventDefault();
    tested.reset();
    saved.mutate({
      ...(address.trim() === '' ? {} : { address: address.trim() }),
      choices: choices.map(({ kind, delivery }) => ({ kind, delivery })),
    });
  };
  return (
    <form className={styles.form} onSubmit={submit}>
      <Field
        label={say('E-mail address')}
        type="email"
        autoComplete="email"
        maxLength={254}
        required={choices.some(({ delivery }) => delivery !== 'off')}
        value={address}
        onChange={(event) => setAddress(event.target.value)}
      />
      {choices.map(({ kind, meaning, delivery }) => (
        <Select
          key={kind}
          label={say(meaning)}
          value={delivery}
          options={kDeliveries.map((one) => ({ ...one, text: say(one.text) }))}
          onChange={({ target }) => {
            const chosen = kDeliveries.find(({ value }) => value === target.value)?.value ?? 'off';
            setChoices(choices.map((one) => (one.kind === kind ? { ...one, delivery: chosen } : one)));
          }}
        />
      ))}
      <p className={styles.muted}>
        {say('A message names what happened and links to its page. Messages of once a day come at 06:00 UTC.')}
      </p>
      {failed ? (
        <Notice tone="bad" title={say('The action failed.')}>
          {failed.message}
        </Notice>
      ) : tested.isSuccess ? (
        <Notice title={say('A test message is on its way.')} />
      ) : saved.isSuccess ? (
        <Notice title={say('Saved.')} />
      ) : null}
      <div className={styles.buttons}>
        <Button look="solid" type="submit" disabled={saved.isPending}>
          {say('Save')}
        </Button>
        <Button onClick={() => tested.mutate()} disabled={tested.isPending || now.address === null || !now.mail}>
          {say('Send a test')}
        </Button>
      </div>
    </form>
  );
}

/** Of what the signed-in person is told. */
export function OwnNotificationsPage() {
  useTitle(say('Notifications'));
  const query = useQuery(ownNotificationsQuery);
  return (
    <div className={styles.page}>
      <div>
        <h1>{say('Notifications')}</h1>
        <p className={styles.lead}>
          {say('Choose what you are told by e-mail. Everything is off until you choose it.')}
        </p>
      </div>
      {query.isError ? (
        <Notice tone="bad" title={say('The choices could not be loaded.')} onRetry={() => void query.refetch()}>
          {query.error.message}
        </Notice>
      ) : null}
      {query.data && !query.data.mail ? (
        <Notice tone="warn" title={say('This server sends no e-mail yet.')}>
          {say('Your choices are kept. An administrator states the mail server.')}
        </Notice>
      ) : null}
      <Card title={say('E-mail')}>
        {query.data ? (
          query.data.choices.length > 0 ? (
            <Choices now={query.data} />
          ) : (
            <p>{say('There are no events for your role.')}</p>
          )
        ) : null}
      </Card>
    </div>
  );
}
