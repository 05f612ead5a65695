-- What lists are searched and sorted by, a narrow row each, so that a page is found without reading the wide ones. They only find:
-- what is shown, and to whom, comes from the rows themselves.
create table trial_entries (
  trial_id text primary key references trials (id),
  started_utc_us bigint not null,
  duration_s double precision not null,
  case_title text not null,
  station text not null,
  person text not null,
  correct bigint,
  state text not null,
  study_id text,
  participant text,
  account_id text,
  words text not null
);
insert into trial_entries (trial_id, started_utc_us, duration_s, case_title, station, person, correct, state, study_id, participant,
    account_id, words)
  select t.id, t.started_utc_us, t.duration_s, c.title, s.name, coalesce(u.name, t.operator_name), t.correct, t.state, k.study_id,
    k.participant, p.account_id, c.title || ' ' || s.name || ' ' || t.operator_name || ' ' || coalesce(u.name, '')
  from trials t join cases c on c.id = t.case_id join stations s on s.id = t.station_id
  left join study_trials x on x.trial_id = t.id left join study_slots k on k.id = x.slot_id
  left join assignment_people p on p.study_id = k.study_id and p.participant = k.participant
  left join accounts u on u.id = p.account_id;
create index trial_entries_by_start on trial_entries (started_utc_us, trial_id);
create index trial_entries_by_case on trial_entries (case_title, trial_id);
create index trial_entries_by_person on trial_entries (person, trial_id);
create index trial_entries_by_station on trial_entries (station, trial_id);
create index trial_entries_by_duration on trial_entries (duration_s, trial_id);
create index trial_entries_by_account on trial_entries (account_id);

-- The slots that are still to be done: few of many.
create index study_slots_open on study_slots (study_id, participant) where state in ('waiting', 'taken');

-- An assignment without a due time has the year 2255.
create table assignment_entries (
  study_id text primary key references assignments (study_id),
  finished bigint not null,
  due_utc_us bigint not null,
  made_utc_us bigint not null,
  title text not null,
  cohort_name text not null,
  release text not null,
  made_by_id text not null,
  cohort_id text,
  words text not null
);
insert into assignment_entries (study_id, finished, due_utc_us, made_utc_us, title, cohort_name, release, made_by_id, cohort_id, words)
  select a.study_id, case when exists (select 1 from study_slots k where k.study_id = a.study_id and
      k.state in ('waiting', 'taken')) then 0 else 1 end,
    coalesce(a.due_utc_us, 9000000000000000), s.made_utc_us, s.title, coalesce(c.name, ''), a.release, a.made_by_id, a.cohort_id,
    s.title || ' ' || coalesce(c.name, '') || ' ' || s.made_by
  from assignments a join studies s on s.id = a.study_id left join cohorts c on c.id = a.cohort_id;
create index assignment_entries_by_urgency on assignment_entries (finished, due_utc_us, study_id);
create index assignment_entries_by_due on assignment_entries (due_utc_us, study_id);
create index assignment_entries_by_time on assignment_entries (made_utc_us, study_id);
create index assignment_entries_by_title on assignment_entries (title, study_id);
create index assignment_entries_by_cohort_name on assignment_entries (cohort_name, study_id);
create index assignment_entries_by_maker on assignment_entries (made_by_id);
create index assignment_entries_by_cohort on assignment_entries (cohort_id);
-- How far each person of an assignment is.
create table assigned_progress (
  account_id text not null,
  study_id text not null,
  participant text not null,
  finished bigint not null,
  primary key (account_id, study_id),
  foreign key (study_id, account_id) references assignment_people (study_id, account_id)
);
insert into assigned_progress (account_id, study_id, participant, finished)
  select p.account_id, p.study_id, p.participant, case when exists (select 1 from study_slots k where k.study_id = p.study_id and
    k.participant = p.participant and k.state in ('waiting', 'taken')) then 0 else 1 end from assignment_people p;
create index assigned_progress_by_participant on assigned_progress (study_id, participant);

create index accounts_by_name on accounts (name, id);
create index accounts_by_role on accounts (role, name, id);
create index accounts_by_level on accounts (level, name, id);
create index accounts_by_time on accounts (made_utc_us, id);

create index audit_by_who on audit (who, number);
create index audit_by_what on audit (what, number);

create index cases_by_publication on cases (kind, published_utc_us, id);
create index cases_by_title on cases (kind, title, id);
create index cases_by_source on cases (kind, source, id);
create index cases_by_time on cases (kind, made_utc_us, id);

-- Addresses of pages that a person gave a name.
create table saved_views (
  id text primary key,
  account_id text not null references accounts (id),
  page text not null,
  name text not null,
  search text not null,
  made_utc_us bigint not null,
  unique (account_id, page, name)
);
