import { useQuery } from '@tanstack/react-query';
import { Link } from 'wouter';
import { outboxQuery, type Outbox, type OutboxDelivery } from '@/api';
import { Badge, Card, DataTable, Facts, Notice, useTitle } from '@/ui';
import { formatCount, formatDateTime } from '@/units';
import styles from './notifications.module.css';
import { WebhooksCard } from './webhooks-card';

const kTones = { waiting: 'neutral', sent: 'good', 'given up': 'bad', withdrawn: 'neutral' } as const;

function MailServerCard({ mail }: Pick<Outbox, 'mail'>) {
  return (
    <Card title="Mail server">
      {mail ? (
        <div className={styles.stack}>
          <Facts
            facts={[
              { name: 'Server', value: mail.server },
              { name: 'Sender', value: mail.from },
              { name: 'Recipients', value: mail.domains.length > 0 ? mail.domains.join(', ') : 'any domain' },
            ]}
          />
          <p className={styles.muted}>
            Send a test to your own address on <Link href="/account/notifications">Notifications</Link>.
          </p>
        </div>
      ) : (
        <p>
          No mail server is stated. Start the server with <code>--mail FILE</code>.
        </p>
      )}
    </Card>
  );
}

function DeliveriesCard({ outbox }: { readonly outbox: Outbox }) {
  return (
    <Card title="Deliveries">
      <div className={styles.stack}>
        <p role="status">
          {formatCount(outbox.waiting)} waiting, {formatCount(outbox.sent_within_day)} sent within a day.
        </p>
        <DataTable<OutboxDelivery>
          caption="Deliveries"
          order="newest first"
          minWidth={720}
          rows={outbox.deliveries}
          keyOf={({ id }) => id}
          empty="Nothing was sent yet."
          columns={[
            { name: 'Event at', by: (one) => one.made_utc_us, cell: (one) => formatDateTime(one.made_utc_us) },
            {
              name: 'By',
              by: (one) => one.channel,
              cell: (one) => (one.channel === 'mail' ? 'e-mail' : 'webhook'),
            },
            {
              name: 'State',
              by: (one) => one.state,
              cell: (one) => <Badge tone={kTones[one.state]}>{one.state}</Badge>,
            },
            { name: 'Attempts', by: (one) => one.attempts, cell: (one) => formatCount(one.attempts), number: true },
            {
              name: 'Next attempt',
              cell: (one) => (one.state === 'waiting' ? formatDateTime(one.due_utc_us) : '–'),
            },
            { name: 'Reason', cell: (one) => one.error },
          ]}
        />
      </div>
    </Card>
  );
}

/** Mail server, webhooks and deliveries, for administrators. */
export function MailPage() {
  useTitle('Mail and webhooks');
  const query = useQuery(outboxQuery);
  const outbox = query.data;
  return (
    <div className={styles.page}>
      <div>
        <h1>Mail and webhooks</h1>
        <p className={styles.lead}>
          How people and other systems are told of events. Each person chooses on{' '}
          <Link href="/account/notifications">Notifications</Link>.
        </p>
      </div>
      {query.isError ? (
        <Notice tone="bad" title="The deliveries could not be loaded." onRetry={() => void query.refetch()}>
          {query.error.message}
        </Notice>
      ) : null}
      {outbox && outbox.given_up_within_week > 0 ? (
        <Notice tone="bad" title={`${formatCount(outbox.given_up_within_week)} deliveries were given up this week.`}>
          The list below says why. Each is in the audit trail.
        </Notice>
      ) : null}
      {outbox ? (
        <>
          <MailServerCard mail={outbox.mail} />
          <WebhooksCard webhooks={outbox.webhooks} />
          <DeliveriesCard outbox={outbox} />
        </>
      ) : null}
    </div>
  );
}
