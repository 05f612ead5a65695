-- Runs of the lab of every kind (diagnosis, comparison, fit); until now there were diagnoses alone.
create table lab_runs (
  id text primary key,
  kind text not null,
  model_id text not null references models (id),
  against_id text references models (id),
  set_id text not null references measurement_sets (id),
  wish text not null,
  state text not null,
  share double precision not null,
  phase text not null,
  stop bigint not null,
  ranking text,
  result text references objects (sha256),
  report text references objects (sha256),
  samples text references objects (sha256),
  model_sha256 text references objects (sha256),
  error text not null,
  made_utc_us bigint not null,
  made_by text not null,
  changed_utc_us bigint not null
);
insert into lab_runs (id, kind, model_id, set_id, wish, state, share, phase, stop, result, report, error,
  made_utc_us, made_by, changed_utc_us)
  select id, 'diagnosis', model_id, set_id, '{}', state, share, '', stop, result, report, error,
    made_utc_us, made_by, changed_utc_us from diagnoses;
drop table diagnoses;
update jobs set kind = 'lab' where kind = 'diagnosis';
create index lab_runs_by_time on lab_runs (made_utc_us, id);

-- Where a version comes from: any run may have made it, and a person may say why.
alter table models rename column diagnosis_id to run_id;
alter table models add column note text not null default '';

-- What a set was found to hold when it came; null: it came before this was asked.
alter table measurement_sets add column rig text;
alter table measurement_sets add column simulated bigint;
alter table measurement_sets add column trials bigint;
alter table measurement_sets add column samples bigint;
