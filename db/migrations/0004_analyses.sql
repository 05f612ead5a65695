-- Analysis plans, locked: who, when, and how many scored trials the server held by then.
create table analysis_plans (
  id text primary key,
  title text not null,
  study text not null,
  plan text not null references objects (sha256),
  data_seen bigint not null,
  trials_then bigint not null,
  made_utc_us bigint not null,
  made_by text not null
);
create index analysis_plans_by_time on analysis_plans (made_utc_us, id);

-- Runs of a plan, or of one method without one, on a snapshot that is frozen when the run begins.
create table analyses (
  id text primary key,
  plan_id text references analysis_plans (id),
  study text not null,
  plan text not null references objects (sha256),
  state text not null,
  share double precision not null,
  snapshot text references objects (sha256),
  description text references objects (sha256),
  result text references objects (sha256),
  report text references objects (sha256),
  data text references objects (sha256),
  error text not null,
  made_utc_us bigint not null,
  made_by text not null,
  changed_utc_us bigint not null
);
create index analyses_by_plan on analyses (plan_id, made_utc_us);
create index analyses_by_snapshot on analyses (snapshot);
