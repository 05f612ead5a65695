-- Learning platforms (LTI 1.3) that may open the pages of this server. deployments: ids of the deployments, a JSON array.
create table lti_platforms (
  id text primary key,
  issuer text not null,
  client_id text not null,
  deployments text not null,
  authorization_url text not null,
  token_url text not null,
  keys_url text not null,
  match_email bigint not null,
  made_utc_us bigint not null,
  made_by text not null,
  unique (issuer, client_id)
);
-- Nonces of accepted launches, until a launch with such a nonce is too old anyway.
create table lti_nonces (
  nonce text primary key,
  until_utc_us bigint not null
);
-- Where the score of a person in an assignment goes: a line item of the platform's gradebook, as the last launch stated it.
-- sent: the score that the platform has; delivery_id: the newest delivery (deliveries), which may be removed already.
create table lti_line_items (
  platform_id text not null references lti_platforms (id),
  study_id text not null references assignments (study_id),
  account_id text not null references accounts (id),
  subject text not null,
  url text not null,
  sent text not null,
  delivery_id text,
  primary key (platform_id, study_id, account_id)
);
create index lti_line_items_by_delivery on lti_line_items (delivery_id);
-- The key with which the server signs its requests to platforms; the private part is encrypted with a key that is not in the database.
create table lti_keys (
  kid text primary key,
  private_key text not null,
  public_key text not null,
  made_utc_us bigint not null
);
