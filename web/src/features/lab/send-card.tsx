import { useMutation, useQuery, useQueryClient } from '@tanstack/react-query';
import { useState, type FormEvent } from 'react';
import { recallModel, sendModel, sentModelQuery, type ModelVersion, type SentModel } from '@/api';
import { say, Sentence } from '@/language';
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
          {one.state === 'there' ? (
            <Badge tone="good">{say('received')}</Badge>
          ) : (
            <Badge tone="accent">{say('pending')}</Badge>
          )}
          <span className={styles.muted}>
            {' '}
            {one.there_utc_us !== null
              ? formatDateTime(one.there_utc_us)
              : one.asked_utc_us === null
                ? ''
                : say('sent {time} by {name}', { time: formatDateTime(one.asked_utc_us), name: one.asked_by })}
          </span>{' '}
          <Button
            look="quiet"
            label={say('Recall from {station}', { station: one.name })}
            onClick={() => onRecall(one)}
          >
            {say('Recall…')}
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
    <Card title={say('Send to stations')}>
      <div className={styles.stack}>
        <p className={styles.readable}>
          <Sentence
            text="A station downloads the version when it next connects to the server. Then it can be started with this version: <code>{command}</code>. The station uses the same file that the lab compared."
            values={{ command: `tractus-station --model "${version.name}"` }}
            parts={{ code: (words) => <code>{words}</code> }}
          />
        </p>
        {sent.isError ? (
          <Notice tone="bad" title={say('The stations could not be loaded.')} onRetry={() => void sent.refetch()}>
            {sent.error.message}
          </Notice>
        ) : null}
        {sent.isPending ? <Skeleton height="28px" width="320px" /> : <SentStations sent={there} onRecall={setDialog} />}
        {made.isError ? (
          <Notice tone="bad" title={say('The version was not sent.')}>
            {made.error.message}
          </Notice>
        ) : null}
        {asking && open.length > 0 ? (
          <form className={styles.stack} onSubmit={submit}>
            <fieldset className={styles.picks}>
              <legend>{say('Stations')}</legend>
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
                {made.isPending ? say('Sending…') : say('Send')}
              </Button>{' '}
              <Button onClick={() => setAsking(false)}>{say('Cancel')}</Button>
            </p>
          </form>
        ) : (
          <p className={styles.buttons} hidden={open.length === 0}>
            <Button look="solid" onClick={() => setDialog('send')} disabled={made.isPending || sent.isPending}>
              {made.isPending ? say('Sending…') : say('Send to all stations…')}
            </Button>
            <Button onClick={() => setAsking(true)} disabled={made.isPending}>
              {say('Choose stations…')}
            </Button>
          </p>
        )}
        {sent.data && open.length === 0 ? (
          <p className={styles.muted}>
            {all.length === 0 ? say('No stations are enrolled yet.') : say('The version was sent to all stations.')}
          </p>
        ) : null}
      </div>
      {dialog === 'send' ? (
        <AskDialog
          title={say('Send “{model}” to {count, plural, one {one station} other {# stations}}?', {
            model: version.name,
            count: open.length,
          })}
          action={say('Send')}
          onClose={() => setDialog(null)}
          onAction={() => made.mutateAsync(null)}
        >
          <p>
            {say('{stations}: trials can be started with this version from then on. It can be recalled.', {
              stations: open.map(({ name }) => name).join(', '),
            })}
          </p>
        </AskDialog>
      ) : null}
      {dialog !== null && dialog !== 'send' ? (
        <AskDialog
          title={say('Recall “{model}” from {station}?', { model: version.name, station: dialog.name })}
          action={say('Recall')}
          onClose={() => setDialog(null)}
          onAction={() => recallModel(version.id, dialog.id).then(store)}
        >
          <p>
            {say(
              'The station forgets the version when it next connects to the server. Trials that were done with it stay as they are.',
            )}
          </p>
        </AskDialog>
      ) : null}
    </Card>
  );
}
