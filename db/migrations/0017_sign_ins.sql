-- Failures to get in, added up by whom and from where; each leaks away with time. A kind of secret has names of its own, so that an
-- account called like a badge slows down nobody else.
drop table login_failures;
create table sign_in_failures (
  secret text not null,
  total text not null,
  name text not null,
  origin text not null,
  failures double precision not null,
  at_utc_us bigint not null,
  primary key (secret, total, name, origin)
);
create index sign_in_failures_by_time on sign_in_failures (at_utc_us);
-- From where an account came in: there it is not slowed down by failures elsewhere.
create table known_origins (
  account_id text not null references accounts (id) on delete cascade,
  secret text not null,
  origin text not null,
  seen_utc_us bigint not null,
  primary key (account_id, secret, origin)
);
create index known_origins_by_origin on known_origins (secret, origin);
