-- Which version of a model a station is to have, and since when it says that it has it.
create table station_models (
  station_id text not null references stations (id),
  model_id text not null references models (id),
  asked_utc_us bigint not null,
  asked_by text not null,
  there_utc_us bigint,
  primary key (station_id, model_id)
);
