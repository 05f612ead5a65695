-- Models: each version is a row of its own, never changed, with where it came from.
create table models (
  id text primary key,
  name text not null,
  rig text not null,
  sha256 text not null references objects (sha256),
  parent text references models (id),
  diagnosis_id text,
  made_utc_us bigint not null,
  made_by text not null
);

-- Measurements, each a zip; `id` is its SHA-256.
create table measurement_sets (
  id text primary key references objects (sha256),
  name text not null,
  made_utc_us bigint not null,
  made_by text not null
);

-- Runs of the lab: which effect does this model lack by these measurements?
create table diagnoses (
  id text primary key,
  model_id text not null references models (id),
  set_id text not null references measurement_sets (id),
  state text not null,
  share double precision not null,
  stop bigint not null,
  result text references objects (sha256),
  report text references objects (sha256),
  error text not null,
  made_utc_us bigint not null,
  made_by text not null,
  changed_utc_us bigint not null
);
create index diagnoses_by_time on diagnoses (made_utc_us, id);
