-- Personal API tokens, with which a person's programs call the server: within scopes (words with blanks between them), until a date.
create table api_tokens (
  id text primary key,
  account_id text not null references accounts (id),
  name text not null,
  token_hash text not null unique,
  scopes text not null,
  made_utc_us bigint not null,
  expires_utc_us bigint not null,
  revoked_utc_us bigint,
  revoked_by text not null default ''
);
create index api_tokens_by_account on api_tokens (account_id);
-- The last use, to the minute: written often, so in no row that the audit trail covers.
create table api_token_uses (
  token_id text primary key references api_tokens (id),
  used_utc_us bigint not null
);
