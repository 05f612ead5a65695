-- What a person agreed that research may have of theirs: everywhere ('' for the study) or in one study. The person is an account,
-- or ('' for the account) a participant of the study who is nobody's account.
create table consents (
  account_id text not null,
  study_id text not null,
  participant text not null,
  tier text not null,
  basis text not null,
  noted_utc_us bigint not null,
  noted_by text not null,
  primary key (account_id, study_id, participant)
);
-- Of the key that makes pseudonyms only this is kept here: enough to see that another lies in its place.
create table pseudonym_keys (
  fingerprint text primary key,
  since_utc_us bigint not null
);
-- Whom a provider of identities vouches for: an account only where an administrator said so.
create table oidc_subjects (
  issuer text not null,
  subject text not null,
  account_id text not null references accounts (id),
  linked_utc_us bigint not null,
  linked_by text not null,
  primary key (issuer, subject)
);
create index oidc_subjects_by_account on oidc_subjects (account_id);
