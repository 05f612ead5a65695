import { useMutation, useQuery } from '@tanstack/react-query';
import { auditAsked, auditQuery, checkAudit, kRoles, useSavedViews, type AuditRow } from '@/api';
import { marked, say } from '@/language';
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
          {check.isPending ? say('Verifying…') : say('Verify the audit trail')}
        </Button>
      </p>
      {check.isError ? (
        <Notice tone="bad" title={say('The audit trail could not be verified.')}>
          {check.error.message}
        </Notice>
      ) : null}
      {data?.holds === true ? (
        <Notice
          title={say('The audit trail is intact: {rows} rows, none changed or removed.', {
            rows: formatCount(data.rows ?? 0),
          })}
        >
          {say('Last hash:')} <span className={styles.hash}>{data.hash ?? ''}</span>
        </Notice>
      ) : null}
      {data?.holds === false ? (
        <Notice tone="bad" title={say('The audit trail is not intact: it has been changed.')}>
          {data.failure ?? ''}
        </Notice>
      ) : null}
    </div>
  );
}

const kFilters: readonly ListFilter[] = [
  {
    name: 'role',
    label: marked('Role'),
    choices: [
      ...kRoles.map((value) => ({ value, text: roleName(value) })),
      { value: 'station', text: marked('Station') },
      { value: 'command line', text: marked('Command line') },
      { value: 'server', text: marked('Server') },
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
      lead={say(
        'Every change with its author and time. Each row contains a hash of all rows before it, so that a change to the audit trail itself is detected.',
      )}
    >
      <Card title={say('Integrity check')}>
        <Check />
      </Card>
      {query.isError ? (
        <Notice tone="bad" title={say('The audit trail could not be loaded.')} onRetry={() => void query.refetch()}>
          {query.error.message}
        </Notice>
      ) : null}
      <Card title={say('Changes')}>
        <ListTable<AuditRow>
          caption={say('Changes')}
          list={list}
          page={query.data}
          views={views}
          usual="number"
          searchLabel={say('Find by account, action, object or details')}
          filters={kFilters}
          minWidth={760}
          rows={query.data?.rows}
          keyOf={({ number }) => String(number)}
          empty={say('No changes yet.')}
          columns={[
            { name: marked('Row'), sort: 'number', falls: true, cell: (one) => formatCount(one.number) },
            { name: marked('Time'), cell: (one) => formatClock(one.at_utc_us) },
            {
              name: marked('Account'),
              sort: 'who',
              cell: (one) => (
                <>
                  {one.who} <span className={styles.muted}>{one.role}</span>
                </>
              ),
            },
            {
              name: marked('Action'),
              sort: 'what',
              cell: (one) => (
                <>
                  {sentenceCase(one.what)} <span className={styles.muted}>{one.what}</span>
                </>
              ),
            },
            {
              name: marked('Object'),
              cell: (one) => <span className={styles.muted}>{one.object}</span>,
            },
            { name: marked('Details'), cell: (one) => <span className={styles.muted}>{detailOf(one.detail)}</span> },
            {
              name: (
                <Term
                  align="end"
                  definition={say('First digits of the SHA-256 hash of this row and all rows before it.')}
                >
                  {say('Hash')}
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
