-- People: an account can be switched off, has a pseudonym for research, and a badge with a PIN for stations.
alter table accounts add column state text not null default 'active';
alter table accounts add column pseudonym text;
alter table accounts add column badge text;
alter table accounts add column pin_hash text;
-- The secret of one-time codes, sealed by a key that is not in the database, and the last step used.
alter table accounts add column totp_secret text;
alter table accounts add column totp_confirmed bigint not null default 0;
alter table accounts add column totp_step bigint not null default 0;
alter table accounts add column must_change bigint not null default 0;
create unique index accounts_by_pseudonym on accounts (pseudonym);
create unique index accounts_by_badge on accounts (badge);

alter table stations add column revoked_utc_us bigint;
-- A code lets one station in, once, until it expires; only its hash is kept.
create table enrolment_codes (
  code_hash text primary key,
  station_name text not null,
  made_utc_us bigint not null,
  expires_utc_us bigint not null,
  used_utc_us bigint
);

create table cohorts (
  id text primary key,
  name text not null unique,
  made_utc_us bigint not null,
  made_by text not null
);
create table cohort_people (
  cohort_id text not null references cohorts (id),
  account_id text not null references accounts (id),
  part text not null,
  since_utc_us bigint not null,
  primary key (cohort_id, account_id)
);
create index cohort_people_by_account on cohort_people (account_id, part);

-- An assignment is a study whose participants are accounts, by their pseudonyms.
create table assignments (
  study_id text primary key references studies (id),
  cohort_id text references cohorts (id),
  due_utc_us bigint,
  release text not null,
  made_by_id text not null references accounts (id)
);
create table assignment_people (
  study_id text not null references assignments (study_id),
  account_id text not null references accounts (id),
  participant text not null,
  primary key (study_id, account_id),
  unique (study_id, participant)
);
create index assignment_people_by_account on assignment_people (account_id);
create table assignment_names (
  study_id text not null references assignments (study_id),
  case_id text not null references cases (id),
  name text not null,
  primary key (study_id, case_id)
);
