-- People who left: of their account a row without a name stays, "erased person NUMBER". Name and badge stand here only until they
-- are taken out of the audit trail too (state 'begun').
create table erasures (
  number bigint primary key,
  account_id text not null unique references accounts (id),
  mode text not null,
  cause text not null,
  state text not null,
  name text not null,
  badge text not null,
  begun_utc_us bigint not null,
  done_utc_us bigint
);
-- Trials that went with their person, and the file that each had or was announced with: to be deleted, and never taken again.
create table erased_trials (
  trial_id text primary key,
  erasure bigint not null references erasures (number),
  sha256 text not null,
  deleted bigint not null
);
create index erased_trials_by_erasure on erased_trials (erasure, deleted);
-- Slots that nobody will do any more: a station that still has one is told so.
create table erased_slots (
  slot_id text primary key,
  erasure bigint not null references erasures (number)
);
-- Rows of the audit trail from which a person was taken out: a keyed digest of what the row says now (db/store/operations/audit.hpp).
create table redactions (
  number bigint primary key references audit (number),
  digest text not null
);
-- How long people's data are kept (tractus-retention/1); a row is a version and never changes.
create table retention_rules (
  version bigint primary key,
  definition text not null,
  reason text not null,
  made_utc_us bigint not null,
  made_by text not null
);
-- Whom the rules are going to act on, and when.
create table retention_notices (
  account_id text primary key references accounts (id),
  version bigint not null references retention_rules (version),
  noticed_utc_us bigint not null,
  acts_utc_us bigint not null
);
