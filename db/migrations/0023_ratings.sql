-- Rubrics by which people rate trials (tractus-rubric/1); a row is a version and never changes.
create table rubrics (
  id text not null,
  version bigint not null,
  title text not null,
  definition text not null,
  reason text not null,
  made_utc_us bigint not null,
  made_by text not null,
  primary key (id, version)
);
-- A trial that is to be rated: by this many people, of whom none sees the other's rating before the last has submitted; if it
-- is blind, nor the trainee's name.
create table rating_requests (
  trial_id text not null references trials (id),
  rubric_id text not null,
  version bigint not null,
  blind bigint not null,
  raters bigint not null,
  made_utc_us bigint not null,
  made_by text not null,
  primary key (trial_id, rubric_id),
  foreign key (rubric_id, version) references rubrics (id, version)
);
-- A submitted rating never changes: a rater's next number supersedes the one before, with the reason. independent: the rater
-- could not see another's rating of the trial.
create table ratings (
  trial_id text not null,
  rubric_id text not null,
  rater_id text not null references accounts (id),
  number bigint not null,
  scores text not null,
  comment text not null,
  reason text not null,
  independent bigint not null,
  made_utc_us bigint not null,
  primary key (trial_id, rubric_id, rater_id, number),
  foreign key (trial_id, rubric_id) references rating_requests (trial_id, rubric_id)
);
create index ratings_by_rater on ratings (rater_id);
