-- Rules from an identity provider's groups to roles and cohorts (tractus-groups/1); a row is a version and never changes.
create table group_rules (
  version bigint primary key,
  definition text not null,
  reason text not null,
  made_utc_us bigint not null,
  made_by text not null
);
-- Accounts that a rule made and keeps: when the provider last vouched for the person, and since when none of the rule's groups
-- has them (the account is disabled then; null: it is not).
create table group_accounts (
  account_id text primary key references accounts (id),
  version bigint not null references group_rules (version),
  seen_utc_us bigint not null,
  left_utc_us bigint
);
