-- Imports of series from the PACS, for the person who began each: how far it has come, and what became of it. It names no study and no
-- patient. Rows are kept for a day.
create table pacs_imports (
  id text primary key,
  account_id text not null,
  state text not null,
  files bigint not null,
  size_bytes bigint not null,
  error text not null,
  volume_id text,
  changed_utc_us bigint not null
);
