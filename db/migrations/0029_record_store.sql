-- The learning record store (xAPI) to which statements of trials are sent: one row, or none. The secret is encrypted with a key that is
-- not in the database.
create table record_stores (
  id text primary key,
  endpoint text not null,
  key text not null,
  secret text not null,
  made_utc_us bigint not null,
  made_by text not null
);
-- Trials of which the store has a statement, or of which one waits or was given up (deliveries).
create table record_statements (
  trial_id text not null references trials (id),
  store_id text not null references record_stores (id),
  study_id text not null,
  delivery_id text not null,
  primary key (trial_id, store_id)
);
create index record_statements_by_delivery on record_statements (delivery_id);
