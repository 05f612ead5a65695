-- Who works on a job and until when: it is said again while the work goes on; after that time the job waits again.
alter table jobs add column owner text not null default '';
alter table jobs add column lease_until_utc_us bigint not null default 0;
