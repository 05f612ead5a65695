-- People and machines. A token or a password is never stored, only its hash.
create table accounts (
  id text primary key,
  name text not null unique,
  role text not null,
  password_hash text not null,
  made_utc_us bigint not null
);
create table sessions (
  token_hash text primary key,
  account_id text not null references accounts (id) on delete cascade,
  made_utc_us bigint not null,
  seen_utc_us bigint not null
);
create table login_failures (
  name text not null,
  peer text not null,
  at_utc_us bigint not null
);
create index login_failures_by_name on login_failures (name, at_utc_us);
create table stations (
  id text primary key,
  name text not null unique,
  token_hash text not null unique,
  enrolled_utc_us bigint not null
);

-- Files on disk, named by their SHA-256.
create table objects (
  sha256 text primary key,
  size_bytes bigint not null,
  made_utc_us bigint not null
);

-- Cases: `id` is the SHA-256 of case.json, which is itself a part, as is case.sig.
create table cases (
  id text primary key,
  title text not null,
  source text not null,
  made_utc_us bigint not null,
  published_utc_us bigint not null
);
create table case_parts (
  case_id text not null references cases (id),
  name text not null,
  sha256 text not null references objects (sha256),
  size_bytes bigint not null,
  secret bigint not null,
  primary key (case_id, name)
);

-- Uploads: `offset_bytes` of the file are on the disk, and `crc32c` is theirs.
create table uploads (
  trial_id text primary key,
  station_id text not null references stations (id),
  case_id text not null references cases (id),
  size_bytes bigint not null,
  sha256 text not null,
  offset_bytes bigint not null,
  crc32c bigint not null,
  state text not null,
  announced_utc_us bigint not null
);
create index uploads_by_station on uploads (station_id, state);

-- Trials: a row appears with its whole file in `objects`, or not at all.
create table trials (
  id text primary key references uploads (trial_id),
  case_id text not null references cases (id),
  station_id text not null references stations (id),
  sha256 text not null references objects (sha256),
  operator_name text not null,
  simulated bigint not null,
  started_utc_us bigint not null,
  received_utc_us bigint not null,
  duration_s double precision not null,
  samples bigint not null,
  complete bigint not null,
  late_ticks bigint not null,
  not_converged bigint not null,
  skipped_ticks bigint not null,
  header text not null,
  events text not null,
  state text not null,
  failure text not null,
  correct bigint,
  coverage text
);
create index trials_by_start on trials (started_utc_us, id);
create index trials_by_case on trials (case_id);
create table trial_metrics (
  trial_id text not null references trials (id),
  metric_id text not null,
  position bigint not null,
  value double precision,
  note text not null,
  primary key (trial_id, metric_id)
);

-- Work for later, claimed by any process.
create table jobs (
  id text primary key,
  kind text not null,
  subject text not null,
  state text not null,
  attempts bigint not null,
  error text not null,
  queued_utc_us bigint not null,
  changed_utc_us bigint not null
);
create index jobs_by_state on jobs (state, queued_utc_us);
