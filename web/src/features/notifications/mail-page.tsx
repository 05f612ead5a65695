import { useQuery } from '@tanstack/react-query';
import { Link } from 'wouter';
import { outboxQuery, type Outbox, type OutboxDelivery } from '@/api';
import { marked, say, Sentence } from '@/language';
import { Badge, Card, DataTable, Facts, Notice, useTitle } from '@/ui';
import { formatCount, formatDateTime } from '@/units';
import styles from './notifications.module.css';
import { PlatformsCard } from './platforms-card';
import { RecordStoreCard } from './record-store-card';
import { WebhooksCard } from './webhooks-card';

const kTones = { waiting: 'neutral', sent: 'good', 'given up': 'bad', withdrawn: 'neutral' } as const;
const kStates: Readonly<Record<OutboxDelivery['state'], string>> = {
  waiting: marked('waiting'),
  sent: marked('sent'),
  'given up': marked('given up'),
  withdrawn: marked('withdrawn'),
};
const kChannels: Readonly<Record<OutboxDelivery['channel'], string>> = {
  mail: marked('e-mail'),
  webhook: marked('webhook'),
  lti: marked('score to a learning platform'),
  xapi: marked('statement to the record store'),
};

function MailServerCard({ mail }: Pick<Outbox, 'mail'>) {
  return (
    <Card title={say('Mail server')}>
      {mail ? (
        <div className={styles.stack}>
          <Facts
            facts={[
              { name: say('Server'), value: mail.server },
              { name: say('Sender'), value: mail.from },
              { name: say('Recipients'), value: mail.domains.length > 0 ? mail.domains.join(', ') : say('any domain') },
            ]}
          />
          <p className={styles.muted}>
            <Sentence
              text="Send a test to your own address on <link>Notifications</link>."
              parts={{ link: (words) => <Link href="/account/notifications">{words}</Link> }}
            />
          </p>
        </div>
      ) : (
        <p>
          <Sentence
            text="No mail server is stated. Start the server with <code>--mail FILE</code>."
            parts={{ code: (words) => <code>{words}</code> }}
          />
        </p>
      )}
    </Card>
  );
}

function DeliveriesCard({ outbox }: { readonly outbox: Outbox }) {
  return (
    <Card title={say('Deliveries')}>
      <div className={styles.stack}>
        <p role="status">
          {say('{waiting} waiting, {sent} sent within a day.', {
            waiting: formatCount(outbox.waiting),
            sent: formatCount(outbox.sent_within_day),
          })}
        </p>
        <DataTable<OutboxDelivery>
          caption={say('Deliveries')}
          order={say('newest first')}
          minWidth={720}
          rows={outbox.deliveries}
          keyOf={({ id }) => id}
          empty={say('Nothing was sent yet.')}
          columns={[
            { name: marked('Event at'), by: (one) => one.made_utc_us, cell: (one) => formatDateTime(one.made_utc_us) },
            {
              name: marked('By'),
              by: (one) => one.channel,
              cell: (one) => say(kChannels[one.channel]),
            },
            {
              name: marked('State'),
              by: (one) => say(kStates[one.state]),
              cell: (one) => <Badge tone={kTones[one.state]}>{say(kStates[one.state])}</Badge>,
            },
            {
              name: marked('Attempts'),
              by: (one) => one.attempts,
              cell: (one) => formatCount(one.attempts),
              number: true,
            },
            {
              name: marked('Next attempt'),
              cell: (one) => (one.state === 'waiting' ? formatDateTime(one.due_utc_us) : '–'),
            },
            { name: marked('Reason'), cell: (one) => say(one.error) },
          ]}
        />
      </div>
    </Card>
  );
}

/** Mail server, webhooks, learning platforms, record store and deliveries, for administrators. */
export function MailPage() {
  useTitle(say('Mail and webhooks'));
  const query = useQuery(outboxQuery);
  const outbox = query.data;
  return (
    <div className={styles.page}>
      <div>
        <h1>{say('Mail and webhooks')}</h1>
        <p className={styles.lead}>
          <Sentence
            text="How people and other systems are told of events. Each person chooses on <link>Notifications</link>."
            parts={{ link: (words) => <Link href="/account/notifications">{words}</Link> }}
          />
        </p>
      </div>
      {query.isError ? (
        <Notice tone="bad" title={say('The deliveries could not be loaded.')} onRetry={() => void query.refetch()}>
          {query.error.message}
        </Notice>
      ) : null}
      {outbox && outbox.given_up_within_week > 0 ? (
        <Notice
          tone="bad"
          title={say('{count, plural, one {# delivery was} other {# deliveries were}} given up this week.', {
            count: outbox.given_up_within_week,
          })}
        >
          {say('The list below says why. Each is in the audit trail.')}
        </Notice>
      ) : null}
      {outbox ? (
        <>
          <MailServerCard mail={outbox.mail} />
          <WebhooksCard webhooks={outbox.webhooks} />
          <PlatformsCard />
          <RecordStoreCard />
          <DeliveriesCard outbox={outbox} />
        </>
      ) : null}
    </div>
  );
}
