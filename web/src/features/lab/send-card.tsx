import { useMutation, useQuery, useQueryClient } from '@tanstack/react-query';
import { useState, type FormEvent } from 'react';
import { recallModel, sendModel, sentModelQuery, type ModelVersion, type SentModel } from '@/api';
import { AskDialog, Badge, Button, Card, Notice, Skeleton } from '@/ui';
import { formatDateTime } from '@/units';
import styles from './lab.module.css';

type Sent = SentModel['stations'][number];

function SentStations({
  sent,
  onRecall,
}: {
  readonly sent: readonly Sent[];
  readonly onRecall: (station: Sent) => void;
}) {
  if (sent.length === 0) return null;
  return (
    <ul className={styles.sent} data-part="sent">
      {sent.map((one) => (
        <li key={one.id}>
          <strong>{one.name}</strong>{' '}
          {one.state === 'there' ? <Badge tone="good">received</Badge> : <Badge tone="accent">pending</Badge>}
          <span className={styles.muted}>
            {' '}
            {one.there_utc_us !== null
              ? formatDateTime(one.there_utc_us)
              : one.asked_utc_us === null
                ? ''
                : `sent ${formatDateTime(one.asked_utc_us)} by ${one.asked_by}`}
          </span>{' '}
          <Button look="quiet" label={`Recall from ${one.name}`} onClick={() => onRecall(one)}>
            Recall…
          </Button>
        </li>
      ))}
    </ul>
  );
}

/** Sends a published version to stations. */
export function SendCard({ version }: { readonly version: Pick<ModelVersion, 'id' | 'name' | 'rig'> }) {
  const client = useQueryClient();
  const sent = useQuery(sentModelQuery(version.id));
  const [asking, setAsking] = useState(false);
  const [dialog, setDialog] = useState<'send' | Sent | null>(null);
  const store = (now: SentModel) => client.setQueryData(sentModelQuery(version.id).queryKey, now);
  const made = useMutation({
    mutationFn: (stations: readonly string[] | null) => sendModel(version.id, stations),
    onSuccess: (now) => {
      store(now);
      setAsking(false);
    },
  });
  const [picked, setPicked] = useState<readonly string[]>([]);
  const all = sent.data?.stations ?? [];
  const there = all.filter(({ state }) => state !== 'not_sent'),
    open = all.filter(({ state }) => state === 'not_sent');
  const submit = (event: FormEvent) => {
    event.preventDefault();
    if (picked.length > 0) made.mutate(picked);
  };
  return (
    <Card title="Send to stations">
      <div className={styles.stack}>
        <p className={styles.readable}>
          A station downloads the version when it next connects to the server. Then it can be started with this version:{' '}
          <code>tractus-station --model &quot;{version.name}&quot;</code>. The station uses the same file that the lab
          compared.
        </p>
        {sent.isError ? (
          <Notice tone="bad" title="The stations could not be loaded." onRetry={() => void sent.refetch()}>
            {sent.error.message}
          </Notice>
        ) : null}
        {sent.isPending ? <Skeleton height="28px" width="320px" /> : <SentStations sent={there} onRecall={setDialog} />}
        {made.isError ? (
          <Notice tone="bad" title="The version was not sent.">
            {made.error.message}
          </Notice>
        ) : null}
        {asking && open.length > 0 ? (
          <form className={styles.stack} onSubmit={submit}>
            <fieldset className={styles.picks}>
              <legend>Stations</legend>
              {open.map(({ id, name }) => (
                <label key={id}>
                  <input
                    type="checkbox"
                    checked={picked.includes(id)}
                    onChange={(event) =>
                      setPicked(event.target.checked ? [...picked, id] : picked.filter((one) => one !== id))
                    }
                  />{' '}
                  {name}
                </label>
              ))}
            </fieldset>
            <p className={styles.buttons}>
              <Button look="solid" type="submit" disabled={made.isPending || picked.length === 0}>
                {made.isPending ? 'Sending…' : 'Send'}
              </Button>{' '}
              <Button onClick={() => setAsking(false)}>Cancel</Button>
            </p>
          </form>
        ) : (
          <p className={styles.buttons} hidden={open.length === 0}>
            <Button look="solid" onClick={() => setDialog('send')} disabled={made.isPending || sent.isPending}>
              {made.isPending ? 'Sending…' : 'Send to all stations…'}
            </Button>
            <Button onClick={() => setAsking(true)} disabled={made.isPending}>
              Choose stations…
            </Button>
          </p>
        )}
        {sent.data && open.length === 0 ? (
          <p className={styles.muted}>
            {all.length === 0 ? 'No stations are enrolled yet.' : 'The version was sent to all stations.'}
          </p>
        ) : null}
      </div>
      {dialog === 'send' ? (
        <AskDialog
          title={`Send “${version.name}” to ${open.length === 1 ? 'one station' : `${open.length} stations`}?`}
          action="Send"
          onClose={() => setDialog(null)}
          onAction={() => made.mutateAsync(null)}
        >
          <p>
            {open.map(({ name }) => name).join(', ')}: trials can be started with this version from then on. It can be
            recalled.
          </p>
        </AskDialog>
      ) : null}
      {dialog !== null && dialog !== 'send' ? (
        <AskDialog
          title={`Recall “${version.name}” from ${dialog.name}?`}
          action="Recall"
          onClose={() => setDialog(null)}
          onAction={() => recallModel(version.id, dialog.id).then(store)}
        >
          <p>
            The station forgets the version when it next connects to the server. Trials that were done with it stay as
            they are.
          </p>
        </AskDialog>
      ) : null}
    </Card>
  );
}
