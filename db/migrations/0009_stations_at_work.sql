-- What a station last said of itself, kept for when it is away; and its reports of self-tests and calibrations.
create table station_states (
  station_id text primary key references stations (id),
  seen_utc_us bigint not null,
  told text not null
);
create table station_reports (
  station_id text not null references stations (id),
  kind text not null,
  at_utc_us bigint not null,
  received_utc_us bigint not null,
  body text not null,
  primary key (station_id, kind, at_utc_us)
);
-- How far a station's clock was from the server's when it handed a trial over, and how well that is known.
create table trial_clocks (
  trial_id text primary key references trials (id),
  offset_s double precision not null,
  error_s double precision not null
);
