import { useInfiniteQuery, useMutation } from '@tanstack/react-query';
import { auditQuery, checkAudit, type AuditRow } from '@/api';
import { Button, Card, Notice, Table, Term } from '@/ui';
import { formatClock, formatCount } from '@/units';
import { Frame } from './frame';
import styles from './network.module.css';

const spaced = (operation: string) => { const words = operation.replace(/([A-Z])/g, ' $1').toLowerCase().trim(); return words.charAt(0).toUpperCase() + words.slice(1); };
const detailOf = (detail: AuditRow['detail']) => Object.entries(detail).map(([key, value]) => `${key}: ${typeof value === 'string' ? value : JSON.stringify(value)}`).join(', ');

function Check() {
  const check = useMutation({ mutationFn: checkAudit });
  const { data } = check;
  return (
    <div className={styles.stack}>
      <p className={styles.buttons}><Button onClick={() => check.mutate()} disabled={check.isPending}>{check.isPending ? 'Reading the whole trail…' : 'Check the whole trail'}</Button></p>
      {check.isError ? <Notice tone="bad" title="It could not be checked.">{check.error.message}</Notice> : null}
      {data?.holds === true ? <Notice title={`The trail holds: ${formatCount(data.rows ?? 0)} rows, none changed or taken out.`}>Its last hash: <span className={styles.hash}>{data.hash ?? ''}</span></Notice> : null}
      {data?.holds === false ? <Notice tone="bad" title="The trail does not hold: somebody has changed it.">{data.failure ?? ''}</Notice> : null}
    </div>
  );
}

/** Every change, by whom, and whether anybody changed the record of it. */
export function AuditPage() {
  const query = useInfiniteQuery(auditQuery);
  const rows = query.data?.pages.flatMap((page) => page.rows);
  return (
    <Frame at="audit" lead="Every change, by whom and when. Each row carries a hash of all rows before it, so that a change to the record itself shows.">
      <Card title="Is the record untouched?"><Check /></Card>
      {query.isError ? <Notice tone="bad" title="The trail could not be loaded." onRetry={() => void query.refetch()}>{query.error.message}</Notice> : null}
      <Card title="Changes, newest first">
        <Table<AuditRow> caption="Changes, newest first" minWidth={760} rows={rows} keyOf={({ number }) => String(number)} empty="Nothing was changed yet." columns={[
          { name: 'Row', cell: (one) => formatCount(one.number) },
          { name: 'When', cell: (one) => formatClock(one.at_utc_us) },
          { name: 'Who', cell: (one) => <>{one.who} <span className={styles.muted}>{one.role}</span></> },
          { name: 'What', cell: (one) => spaced(one.what) },
          { name: 'Of', cell: (one) => <span className={styles.muted}>{one.object}</span> },
          { name: 'Detail', cell: (one) => <span className={styles.muted}>{detailOf(one.detail)}</span> },
          { name: <Term align="end" definition="Of this row and all before it (SHA-256), its first digits.">Hash</Term>, cell: (one) => <span className={styles.hash}>{one.hash.slice(0, 10)}</span> },
        ]} />
        {query.hasNextPage ? <p><Button onClick={() => void query.fetchNextPage()} disabled={query.isFetchingNextPage}>{query.isFetchingNextPage ? 'Loading…' : 'Older changes'}</Button></p> : null}
      </Card>
    </Frame>
  );
}
