-- Every change by a person, a station or the command line; rows are only ever added. `hash` is a keyed hash of the row and of
-- the hash before it: a row altered, taken out or put elsewhere breaks the chain. The key is not in the database.
create table audit (
  number bigint primary key,
  at_utc_us bigint not null,
  who text not null,
  role text not null,
  peer text not null,
  what text not null,
  object text not null,
  detail text not null,
  hash text not null
);
