-- Being told of events by e-mail and by webhooks. Everything is off until somebody chooses it.
create table notification_addresses (
  account_id text primary key references accounts (id),
  address text not null
);
create table notification_choices (
  account_id text not null references accounts (id),
  kind text not null,
  delivery text not null,
  primary key (account_id, kind)
);
-- The secret is encrypted with a key that is not in the database.
create table webhooks (
  id text primary key,
  url text not null,
  kinds text not null,
  secret text not null,
  made_utc_us bigint not null,
  made_by text not null
);
-- Written in the transaction of what happened; the key keeps an event from being noted twice. spread: its deliveries are queued.
create table notification_events (
  id text primary key,
  kind text not null,
  key text not null unique,
  subject text not null,
  at_utc_us bigint not null,
  spread bigint not null
);
create index notification_events_new on notification_events (at_utc_us, id) where spread = 0;
-- The outbox: a message to one recipient (an account or a webhook). batch: that of a daily message, which collects the events of a
-- day until it is due.
create table deliveries (
  id text primary key,
  channel text not null,
  recipient text not null,
  batch text unique,
  state text not null,
  attempts bigint not null,
  made_utc_us bigint not null,
  due_utc_us bigint not null,
  claimed_until_us bigint not null,
  changed_utc_us bigint not null,
  error text not null
);
create index deliveries_waiting on deliveries (channel, due_utc_us, id) where state = 'waiting';
create index deliveries_by_change on deliveries (changed_utc_us);
create table delivery_events (
  delivery_id text not null references deliveries (id),
  event_id text not null references notification_events (id),
  primary key (delivery_id, event_id)
);
