-- The trace that a job belongs to, as the W3C header traceparent writes it; empty: none.
alter table jobs add column traceparent text not null default '';
