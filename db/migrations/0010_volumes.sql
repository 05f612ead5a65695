-- CT volumes that people brought in, without the patient: held until a person has looked at them and releases them. `facts` is
-- what the file is (geometry, values), `report` what de-identification did, by attribute and without values.
create table volumes (
  id text primary key,
  name text not null,
  source text not null,
  state text not null,
  sha256 text references objects (sha256),
  size_bytes bigint not null,
  facts text not null,
  report text not null,
  made_utc_us bigint not null,
  made_by text not null,
  made_by_id text not null,
  decided_utc_us bigint,
  decided_by text,
  reason text not null default ''
);
create index volumes_by_object on volumes (sha256);
