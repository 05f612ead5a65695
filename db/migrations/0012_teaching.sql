-- Cases that are made of volumes: what was asked, how far it is, what came of it.
create table case_makings (
  id text primary key,
  volume_id text not null,
  title text not null,
  plan text not null,
  state text not null,
  share double precision not null,
  phase text not null,
  error text not null,
  case_id text references cases (id),
  made_utc_us bigint not null,
  made_by text not null,
  changed_utc_us bigint not null
);
create index case_makings_by_time on case_makings (made_utc_us, id);

-- A case that is retired is offered no more; what was assigned of it goes on.
alter table cases add column retired_utc_us bigint;

-- Scenarios that people wrote here, a row a version; `id` is the version's own, of its contents.
create table scenario_versions (
  id text primary key,
  sha256 text not null references objects (sha256),
  name text not null,
  kind text not null,
  parent text,
  published bigint not null,
  made_utc_us bigint not null,
  made_by text not null
);
create index scenario_versions_by_time on scenario_versions (made_utc_us, id);

-- What those who teach say of a trial; at_s: of this moment of it.
create table trial_comments (
  id text primary key,
  trial_id text not null references trials (id),
  at_s double precision,
  text text not null,
  by_id text not null references accounts (id),
  by_name text not null,
  made_utc_us bigint not null
);
create index trial_comments_by_trial on trial_comments (trial_id, made_utc_us);

-- Trials that are offered as an example on their case.
create table reference_trials (
  trial_id text primary key references trials (id),
  made_utc_us bigint not null,
  made_by text not null
);
