/** Of what people are told by e-mail, webhooks, and what became of the messages. */
import { queryOptions } from '@tanstack/react-query';
import * as v from 'valibot';
import { address } from './address';
import { request, requestJson } from './client';
import { count, inUtc } from './quantities';

const kKinds = ['due', 'overdue', 'released', 'relapse', 'self_test_failed', 'backup_failed', 'test'] as const;
const kDeliveries = ['off', 'immediate', 'daily'] as const;
export type NotificationKind = (typeof kKinds)[number];
export type NotificationDelivery = (typeof kDeliveries)[number];
/** The kinds that a webhook may have. */
export const kWebhookKinds = kKinds.filter((kind) => kind !== 'test');

export const ownNotificationsSchema = v.object({
  mail: v.boolean(),
  address: v.nullable(v.string()),
  choices: v.array(v.object({ kind: v.picklist(kKinds), meaning: v.string(), delivery: v.picklist(kDeliveries) })),
});
const webhookSchema = v.object({
  id: v.string(),
  url: v.string(),
  kinds: v.array(v.picklist(kKinds)),
  made_utc_us: inUtc,
  made_by: v.string(),
});
export const webhookMadeSchema = v.object({ webhook: webhookSchema, secret: v.string() });
export const outboxSchema = v.object({
  mail: v.nullable(v.object({ server: v.string(), from: v.string(), domains: v.array(v.string()) })),
  webhooks: v.array(webhookSchema),
  waiting: count,
  sent_within_day: count,
  given_up_within_week: count,
  deliveries: v.array(
    v.object({
      id: v.string(),
      channel: v.picklist(['mail', 'webhook', 'lti', 'xapi']),
      recipient: v.string(),
      state: v.picklist(['waiting', 'sent', 'given up', 'withdrawn']),
      attempts: count,
      made_utc_us: inUtc,
      due_utc_us: inUtc,
      changed_utc_us: inUtc,
      error: v.string(),
    }),
  ),
});
export type Webhook = v.InferOutput<typeof webhookSchema>;
export type Outbox = v.InferOutput<typeof outboxSchema>;
export type OutboxDelivery = Outbox['deliveries'][number];
export type OwnNotifications = v.InferOutput<typeof ownNotificationsSchema>;

export const ownNotificationsQuery = queryOptions({
  queryKey: ['notifications'],
  queryFn: ({ signal }) =>
    requestJson(address('/api/v1/session/notifications', {}), ownNotificationsSchema, { signal }),
});
export const outboxQuery = queryOptions({
  queryKey: ['outbox'],
  queryFn: ({ signal }) => requestJson(address('/api/v1/webhooks', {}), outboxSchema, { signal }),
  refetchInterval: 5000,
});

const posted = { method: 'POST' } as const;
export const setNotifications = (wish: {
  readonly address?: string;
  readonly choices: readonly { readonly kind: NotificationKind; readonly delivery: NotificationDelivery }[];
}) => requestJson(address('/api/v1/session/notifications', {}), ownNotificationsSchema, { ...posted, body: wish });
export const testNotification = () => request(address('/api/v1/session/notifications/test', {}), posted);
export const addWebhook = (wish: { readonly url: string; readonly kinds: readonly NotificationKind[] }) =>
  requestJson(address('/api/v1/webhooks', {}), webhookMadeSchema, { ...posted, body: wish });
export const removeWebhook = (id: string) => request(`/webhooks/${encodeURIComponent(id)}`, { method: 'DELETE' });
export const testWebhook = (id: string) => request(address('/api/v1/webhooks/{id}/test', { id }), posted);
