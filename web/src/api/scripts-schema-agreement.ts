/** As schema-agreement.ts, for API tokens, notifications and learning platforms: what the server describes is what is parsed. */
import type * as v from 'valibot';
import type { components } from './generated/schema';
import type { ltiPlatformSchema, ltiPlatformsSchema, recordStoreSchema } from './learning-queries';
import type { outboxSchema, ownNotificationsSchema, webhookMadeSchema } from './notification-queries';
import type { apiTokenMadeSchema, apiTokensSchema } from './token-queries';

type Served = components['schemas'];
type Takes<Schema extends v.GenericSchema, Answer> = Answer extends v.InferInput<Schema> ? true : false;

export interface ScriptsAgreed {
  readonly tokens: Takes<typeof apiTokensSchema, Served['ApiTokens']>;
  readonly tokenMade: Takes<typeof apiTokenMadeSchema, Served['ApiTokenMade']>;
  readonly notifications: Takes<typeof ownNotificationsSchema, Served['OwnNotifications']>;
  readonly outbox: Takes<typeof outboxSchema, Served['Outbox']>;
  readonly webhookMade: Takes<typeof webhookMadeSchema, Served['WebhookMade']>;
  readonly ltiPlatform: Takes<typeof ltiPlatformSchema, Served['LtiPlatform']>;
  readonly ltiPlatforms: Takes<typeof ltiPlatformsSchema, Served['LtiPlatforms']>;
  readonly recordStore: Takes<typeof recordStoreSchema, Served['RecordStore']>;
}

export const kScriptsAgreed: ScriptsAgreed = {
  tokens: true,
  tokenMade: true,
  notifications: true,
  outbox: true,
  webhookMade: true,
  ltiPlatform: true,
  ltiPlatforms: true,
  recordStore: true,
};
