-- A series of trials is a study of research or an assignment of teaching; until now the row in `assignments` alone said which.
alter table studies add column kind text not null default 'study';
update studies set kind = 'assignment' where id in (select study_id from assignments);

-- Whom those who lead a cohort would like to have in it, by the name that they typed: it may be nobody's. The person decides.
create table cohort_invitations (
  cohort_id text not null references cohorts (id),
  account_name text not null,
  made_utc_us bigint not null,
  made_by text not null,
  primary key (cohort_id, account_name)
);
create index cohort_invitations_by_name on cohort_invitations (account_name);
