-- What passing is (tractus-criteria/1): of the whole programme, of a case, of an assignment. A row is a version and never changes.
create table criteria (
  kind text not null,
  subject text not null,
  version bigint not null,
  definition text not null,
  reason text not null,
  made_utc_us bigint not null,
  made_by text not null,
  primary key (kind, subject, version)
);
-- Curricula (tractus-curriculum/1); a row is a version and never changes.
create table curricula (
  id text not null,
  version bigint not null,
  title text not null,
  definition text not null,
  reason text not null,
  made_utc_us bigint not null,
  made_by text not null,
  primary key (id, version)
);
-- The assignment that hands out a step's cases: who has it, is in this version of the curriculum.
create table curriculum_steps (
  study_id text primary key references assignments (study_id),
  curriculum_id text not null,
  version bigint not null,
  step_id text not null,
  foreign key (curriculum_id, version) references curricula (id, version)
);
create index curriculum_steps_by_curriculum on curriculum_steps (curriculum_id, version);
