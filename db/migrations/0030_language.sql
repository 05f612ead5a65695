-- Language of a person's pages and e-mails ("de"); empty: not chosen.
alter table accounts add column language text not null default '';
