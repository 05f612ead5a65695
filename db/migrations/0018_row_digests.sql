-- Digests of the rows that a transaction changed, in the tables that the audit trail covers: JSON, [[table, [key …], digest] …],
-- the digest empty for a row that was deleted. The row's hash covers it when there are any.
alter table audit add column changes text not null default '';
-- Where the trail began to cover rows: looked up at every start.
create index audit_by_coverage on audit (number) where what = 'beginCoverage';
