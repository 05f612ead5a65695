import { useMutation, useQuery, useQueryClient } from '@tanstack/react-query';
import { backupsQuery, makeBackup, verifyBackup, type Backup } from '@/api';
import { marked, say } from '@/language';
import { Badge, Bar, Button, Card, DataTable, Notice, Term } from '@/ui';
import { formatBytes, formatCount, formatDateTime, formatShare, share } from '@/units';
import { Frame } from './frame';
import styles from './network.module.css';

const maker = ({ made_by }: Backup) => (made_by === '' ? say('command line') : made_by);
const isBusy = ({ state }: Backup) => state === 'making' || state === 'verifying';

function State({ backup }: { readonly backup: Backup }) {
  if (backup.state === 'failed')
    return (
      <>
        <Badge tone="bad">{say('failed')}</Badge> <span className={styles.muted}>{backup.error}</span>
      </>
    );
  if (!isBusy(backup)) return <Badge tone="good">{say('complete')}</Badge>;
  return (
    <span className={styles.busy}>
      <span>
        {backup.state === 'making' ? say('creating') : say('verifying')}, {formatShare(share(backup.share))}
      </span>
      <Bar share={share(backup.share)} tone="accent" />
    </span>
  );
}

function Verified({ backup: { verified } }: { readonly backup: Backup }) {
  if (verified === null) return <span className={styles.muted}>{say('not verified')}</span>;
  return verified.holds ? (
    <>
      <Badge tone="good">{say('passed')}</Badge>{' '}
      <span className={styles.muted}>{formatDateTime(verified.at_utc_us)}</span>
    </>
  ) : (
    <>
      <Badge tone="bad">{say('failed')}</Badge>
      <ul className={styles.findings}>
        {verified.findings.map((line) => (
          <li key={line}>{line}</li>
        ))}
      </ul>
    </>
  );
}

/** Backups: creates them while the server runs, and verifies them by restoring. */
export function BackupsPage() {
  const client = useQueryClient();
  const query = useQuery(backupsQuery);
  const fresh = () => client.invalidateQueries({ queryKey: backupsQuery.queryKey });
  const made = useMutation({ mutationFn: makeBackup, onSuccess: fresh });
  const verifying = useMutation({ mutationFn: verifyBackup, onSuccess: fresh });
  const busy = made.isPending || verifying.isPending || query.data?.backups.some(isBusy) === true;
  const failed = made.error ?? verifying.error;
  const newest = query.data?.backups.find(({ verified }) => verified?.holds === true);
  return (
    <Frame
      at="backups"
      lead={say(
        'A backup is a copy of all data at one moment: trials, cases, accounts, keys and the audit trail. The server stays in operation while a backup is created.',
      )}
    >
      {query.isError ? (
        <Notice tone="bad" title={say('The backups could not be loaded.')} onRetry={() => void query.refetch()}>
          {query.error.message}
        </Notice>
      ) : null}
      <Card
        title={say('Backups, newest first')}
        aside={
          <Button look="solid" onClick={() => made.mutate()} disabled={busy || query.isPending}>
            {made.isPending ? say('Starting…') : say('Create backup')}
          </Button>
        }
      >
        <div className={styles.stack}>
          {failed ? (
            <Notice tone="bad" title={say('The action failed.')}>
              {failed.message}
            </Notice>
          ) : null}
          {query.data ? (
            <p className={styles.muted} role="status">
              {newest
                ? say('The newest verified backup was created {time}.', {
                    time: formatDateTime(newest.made_utc_us),
                  })
                : say('No backup has been verified yet. Verify a backup to be sure that it can be restored.')}
            </p>
          ) : null}
          <DataTable<Backup>
            caption={say('Backups')}
            order={say('newest first')}
            minWidth={720}
            rows={query.data?.backups}
            keyOf={({ id }) => id}
            empty={say('No backups yet. Create the first one.')}
            columns={[
              { name: marked('Created'), by: (one) => one.made_utc_us, cell: (one) => formatDateTime(one.made_utc_us) },
              { name: marked('Created by'), by: maker, cell: maker },
              {
                name: marked('Trials'),
                by: (one) => one.trials,
                cell: (one) => (one.state === 'making' || one.state === 'failed' ? '–' : formatCount(one.trials)),
                number: true,
              },
              {
                name: marked('Size'),
                by: (one) => one.size_bytes,
                cell: (one) => (one.state === 'making' || one.state === 'failed' ? '–' : formatBytes(one.size_bytes)),
                number: true,
              },
              { name: marked('State'), by: (one) => one.state, cell: (one) => <State backup={one} /> },
              {
                name: (
                  <Term
                    align="end"
                    definition={say(
                      'The server restores the backup to a temporary folder and checks every object, the references and the audit trail. Then it removes the folder.',
                    )}
                  >
                    {say('Verified')}
                  </Term>
                ),
                cell: (one) => <Verified backup={one} />,
              },
              {
                name: <span className="hidden-visually">{say('Actions')}</span>,
                cell: (one) =>
                  one.state === 'done' ? (
                    <span className={styles.buttons}>
                      <Button
                        label={say('Verify the backup of {time}', {
                          time: formatDateTime(one.made_utc_us),
                        })}
                        disabled={busy}
                        onClick={() => verifying.mutate(one.id)}
                      >
                        {say('Verify')}
                      </Button>
                    </span>
                  ) : null,
              },
            ]}
          />
          <p className={styles.muted}>
            {say('Backups are stored on the server’s own disk: copy them to another machine. To restore a backup:')}{' '}
            <code>tractus-server restore --from BACKUP --data NEW_FOLDER</code>
          </p>
        </div>
      </Card>
    </Frame>
  );
}
