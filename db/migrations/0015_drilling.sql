-- A case whose bone is whole: its channel is drilled first, and felt then.
alter table cases add column planned bigint not null default 0;

-- With what a trial was done: the burr that made the channel, or the probe that felt it.
alter table study_trials add column tool text not null default 'probe';
