import { useMutation, useQuery, useQueryClient } from '@tanstack/react-query';
import { backupsQuery, makeBackup, verifyBackup, type Backup } from '@/api';
import { Badge, Bar, Button, Card, Notice, Table, Term } from '@/ui';
import { formatBytes, formatCount, formatDateTime, formatShare, share } from '@/units';
import { Frame } from './frame';
import styles from './network.module.css';

const isBusy = ({ state }: Backup) => state === 'making' || state === 'verifying';

function State({ backup }: { readonly backup: Backup }) {
  if (backup.state === 'failed') return <><Badge tone="bad">failed</Badge> <span className={styles.muted}>{backup.error}</span></>;
  if (!isBusy(backup)) return <Badge tone="good">whole</Badge>;
  return <span className={styles.busy}><span>{backup.state === 'making' ? 'being made' : 'being tried'}, {formatShare(share(backup.share))}</span><Bar share={share(backup.share)} tone="accent" /></span>;
}

function Tried({ backup: { verified } }: { readonly backup: Backup }) {
  if (verified === null) return <span className={styles.muted}>not yet</span>;
  return verified.holds
    ? <><Badge tone="good">holds</Badge> <span className={styles.muted}>{formatDateTime(verified.at_utc_us)}</span></>
    : <><Badge tone="bad">does not hold</Badge><ul className={styles.findings}>{verified.findings.map((line) => <li key={line}>{line}</li>)}</ul></>;
}

/** Copies of everything, made while the server serves; one that was tried is one that can be trusted. */
export function BackupsPage() {
  const client = useQueryClient();
  const query = useQuery(backupsQuery);
  const fresh = () => client.invalidateQueries({ queryKey: backupsQuery.queryKey });
  const made = useMutation({ mutationFn: makeBackup, onSuccess: fresh });
  const tried = useMutation({ mutationFn: verifyBackup, onSuccess: fresh });
  const busy = made.isPending || tried.isPending || query.data?.backups.some(isBusy) === true;
  const failed = made.error ?? tried.error;
  const newest = query.data?.backups.find(({ verified }) => verified?.holds === true);
  return (
    <Frame at="backups" lead="A backup is a copy of everything at one moment: trials, cases, accounts, keys, the audit trail. It is made while everything goes on.">
      {query.isError ? <Notice tone="bad" title="The backups could not be loaded." onRetry={() => void query.refetch()}>{query.error.message}</Notice> : null}
      <Card title="Backups, newest first" aside={<Button look="solid" onClick={() => made.mutate()} disabled={busy || query.isPending}>{made.isPending ? 'Beginning…' : 'Make a backup'}</Button>}>
        <div className={styles.stack}>
          {failed ? <Notice tone="bad" title="That was not done.">{failed.message}</Notice> : null}
          {query.data ? <p className={styles.muted} role="status">{newest ? `The newest that is known to hold is of ${formatDateTime(newest.made_utc_us)}.` : 'None has been tried yet: a backup is worth something once it was restored.'}</p> : null}
          <Table<Backup> caption="Backups, newest first" minWidth={720} rows={query.data?.backups} keyOf={({ id }) => id} empty="There is no backup yet. Make the first one." columns={[
            { name: 'Made', cell: (one) => formatDateTime(one.made_utc_us) },
            { name: 'By', cell: (one) => (one.made_by === '' ? 'the command line' : one.made_by) },
            { name: 'Trials', cell: (one) => (one.state === 'making' || one.state === 'failed' ? '–' : formatCount(one.trials)), number: true },
            { name: 'Size', cell: (one) => (one.state === 'making' || one.state === 'failed' ? '–' : formatBytes(one.size_bytes)), number: true },
            { name: 'State', cell: (one) => <State backup={one} /> },
            { name: <Term align="end" definition="It is restored to a folder beside, and everything in that is looked over: each object against its name, the references, the audit trail against its key. Then the folder is removed.">Tried</Term>, cell: (one) => <Tried backup={one} /> },
            { name: <span className="hidden-visually">Decide</span>, cell: (one) => (one.state === 'done' ? <span className={styles.buttons}><Button label={`Try the backup of ${formatDateTime(one.made_utc_us)}`} disabled={busy} onClick={() => tried.mutate(one.id)}>Try it</Button></span> : null) },
          ]} />
          <p className={styles.muted}>Backups lie on the server’s own disk: copy them to another machine. To put one back: <code>tractus-server restore --from BACKUP --data NEW_FOLDER</code></p>
        </div>
      </Card>
    </Frame>
  );
}
