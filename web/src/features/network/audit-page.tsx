import { useMutation, useQuery } from '@tanstack/react-query';
import { auditAsked, auditQuery, checkAudit, kRoles, useSavedViews, type AuditRow } from '@/api';
import { Button, Card, ListTable, Notice, Term, useList, type ListFilter } from '@/ui';
import { formatClock, formatCount } from '@/units';
import { Frame } from './frame';
import { roleName } from './labels';
import styles from './network.module.css';

const sentenceCase = (operation: string) => {
  const sentence = operation
    .replace(/([A-Z])/g, ' $1')
    .toLowerCase()
    .trim();
  return sentence.charAt(0).toUpperCase() + sentence.slice(1);
};
const detailOf = (detail: AuditRow['detail']) =>
  Object.entries(detail)
    .map(([key, value]) => `${key}: ${typeof value === 'string' ? value : JSON.stringify(value)}`)
    .join(', ');

function Check() {
  const check = useMutation({ mutationFn: checkAudit });
  const { data } = check;
  return (
    <div className={styles.stack}>
      <p className={styles.buttons}>
        <Button onClick={() => check.mutate()} disabled={check.isPending}>
          {check.isPending ? 'Verifying…' : 'Verify the audit trail'}
        </Button>
      </p>
      {check.isError ? (
        <Notice tone="bad" title="The audit trail could not be verified.">
          {check.error.message}
        </Notice>
      ) : null}
      {data?.holds === true ? (
        <Notice title={`The audit trail is intact: ${formatCount(data.rows ?? 0)} rows, none changed or removed.`}>
          Last hash: <span className={styles.hash}>{data.hash ?? ''}</span>
        </Notice>
      ) : null}
      {data?.holds === false ? (
        <Notice tone="bad" title="The audit trail is not intact: it has been changed.">
          {data.failure ?? ''}
        </Notice>
      ) : null}
    </div>
  );
}

const kFilters: readonly ListFilter[] = [
  {
    name: 'role',
    label: 'Role',
    choices: [
      ...kRoles.map((value) => ({ value, text: roleName(value) })),
      { value: 'station', text: 'Station' },
      { value: 'command line', text: 'Command line' },
      { value: 'server', text: 'Server' },
    ],
  },
];

/** The audit trail and its integrity check. */
export function AuditPage() {
  const list = useList(auditAsked);
  const query = useQuery(auditQuery(list.query));
  const views = useSavedViews('audit');
  return (
    <Frame
      at="audit"
      lead="Every change with its author and time. Each row contains a hash of all rows before it, so that a change to the audit trail itself is detected."
    >
      <Card title="Integrity check">
        <Check />
      </Card>
      {query.isError ? (
        <Notice tone="bad" title="The audit trail could not be loaded." onRetry={() => void query.refetch()}>
          {query.error.message}
        </Notice>
      ) : null}
      <Card title="Changes">
        <ListTable<AuditRow>
          caption="Changes"
          list={list}
          page={query.data}
          views={views}
          usual="number"
          searchLabel="Find by account, action, object or details"
          filters={kFilters}
          minWidth={760}
          rows={query.data?.rows}
          keyOf={({ number }) => String(number)}
          empty="No changes yet."
          columns={[
            { name: 'Row', sort: 'number', falls: true, cell: (one) => formatCount(one.number) },
            { name: 'Time', cell: (one) => formatClock(one.at_utc_us) },
            {
              name: 'Account',
              sort: 'who',
              cell: (one) => (
                <>
                  {one.who} <span className={styles.muted}>{one.role}</span>
                </>
              ),
            },
            {
              name: 'Action',
              sort: 'what',
              cell: (one) => (
                <>
                  {sentenceCase(one.what)} <span className={styles.muted}>{one.what}</span>
                </>
              ),
            },
            {
              name: 'Object',
              cell: (one) => <span className={styles.muted}>{one.object}</span>,
            },
            { name: 'Details', cell: (one) => <span className={styles.muted}>{detailOf(one.detail)}</span> },
            {
              name: (
                <Term align="end" definition="First digits of the SHA-256 hash of this row and all rows before it.">
                  Hash
                </Term>
              ),
              cell: (one) => <span className={styles.hash}>{one.hash.slice(0, 10)}</span>,
            },
          ]}
        />
      </Card>
    </Frame>
  );
}
