-- Level of training of a person, in the programme's own words ("PGY-2"); an assignment's participants and a cohort's table take it.
alter table accounts add column level text not null default '';
