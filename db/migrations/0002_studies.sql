-- A probing scenario is a case of another kind: its one part, scenario.json, is secret.
alter table cases add column kind text not null default 'palpation';

-- A study: scenarios times repeats, an order of their own for every participant.
create table studies (
  id text primary key,
  title text not null,
  state text not null,
  ordering text not null,
  repeats bigint not null,
  seed bigint not null,
  on_invalid text not null,
  made_utc_us bigint not null,
  made_by text not null
);
create table study_scenarios (
  study_id text not null references studies (id),
  position bigint not null,
  case_id text not null references cases (id),
  primary key (study_id, position)
);
create table study_participants (
  study_id text not null references studies (id),
  name text not null,
  position bigint not null,
  state text not null,
  level text not null,
  experience_years double precision,
  simulated bigint not null,
  enrolled_utc_us bigint not null,
  primary key (study_id, name)
);

-- A slot is one trial to be done. Its id is random and tells nothing: all that a station ever learns.
create table study_slots (
  id text primary key,
  study_id text not null,
  participant text not null,
  position bigint not null,
  attempt bigint not null,
  case_id text not null references cases (id),
  state text not null,
  station_id text references stations (id),
  repeat_of text references study_slots (id),
  changed_utc_us bigint not null,
  foreign key (study_id, participant) references study_participants (study_id, name),
  unique (study_id, participant, position, attempt)
);

-- Which slot a trial was announced for, and what became of it: never deleted.
create table study_trials (
  trial_id text primary key references uploads (trial_id),
  slot_id text not null references study_slots (id),
  state text not null,
  reason text not null,
  changed_utc_us bigint not null
);
create index study_trials_by_slot on study_trials (slot_id);

-- Every change, with who and when; rows are only ever added.
create table study_events (
  study_id text not null references studies (id),
  number bigint not null,
  at_utc_us bigint not null,
  who text not null,
  what text not null,
  participant text,
  slot_id text,
  trial_id text,
  reason text not null,
  primary key (study_id, number)
);
