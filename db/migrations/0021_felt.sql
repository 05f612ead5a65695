-- Whether an ideal observer can tell a case's breaches by feel: untried, told, not told, or not known of a case whose bone does
-- not say. A case of before is untried until the server's job has looked at it.
alter table cases add column felt text not null default 'untried';
