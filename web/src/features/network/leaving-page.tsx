import { useMutation, useQuery, useQueryClient } from '@tanstack/react-query';
import { useState, type FormEvent } from 'react';
import { Link } from 'wouter';
import {
  allAccountsQuery,
  dataOfAccountAddress,
  eraseAccount,
  erasurePreviewQuery,
  type ErasureMode,
  type ErasurePreview,
} from '@/api';
import { Badge, Button, Card, DataTable, Field, Notice } from '@/ui';
import { formatBytes, formatCount } from '@/units';
import { Frame } from './frame';
import styles from './network.module.css';

type Row = ErasurePreview['tables'][number];

const kFates = {
  removed: { text: 'removed', tone: 'bad' },
  changed: { text: 'made anonymous', tone: 'warn' },
  kept: { text: 'kept', tone: 'neutral' },
  none: { text: '', tone: 'neutral' },
} as const;

const kModes: readonly { readonly mode: ErasureMode; readonly name: string; readonly text: string }[] = [
  { mode: 'erase', name: 'Erase', text: 'The account, its trials and their recordings are removed.' },
  {
    mode: 'anonymise',
    name: 'Anonymise',
    text: 'The account is removed. Trials and scores stay by a pseudonym that nothing links to the person any more.',
  },
];

function Counts({ preview }: { readonly preview: ErasurePreview }) {
  return (
    <>
      {preview.files > 0 ? (
        <p>
          {formatCount(preview.files)} recordings ({formatBytes(preview.file_bytes)}) are deleted from the disk
          {preview.open_uploads > 0
            ? `, ${formatCount(preview.open_uploads)} of them while a station is still uploading: the station is told`
            : ''}
          .
        </p>
      ) : null}
      <DataTable<Row>
        caption="What becomes of the records"
        order="by area"
        minWidth={640}
        rows={preview.tables}
        keyOf={({ table }) => table}
        empty="Nothing is recorded of this person."
        columns={[
          { name: 'Records', cell: (one) => one.what },
          { name: 'Rows', cell: (one) => (one.fate === 'kept' ? '–' : formatCount(one.rows)), number: true },
          { name: 'Afterwards', cell: (one) => <Badge tone={kFates[one.fate].tone}>{kFates[one.fate].text}</Badge> },
          { name: 'Why', cell: (one) => one.reason },
        ]}
      />
    </>
  );
}

/** Erases or anonymises a person, after showing what that does. */
export function LeavingPage({ id }: { readonly id: string }) {
  const client = useQueryClient();
  const [mode, setMode] = useState<ErasureMode>('erase');
  const [typed, setTyped] = useState('');
  const done = useMutation({
    mutationFn: () => eraseAccount(id, mode, typed),
    onSuccess: () => client.invalidateQueries({ queryKey: allAccountsQuery.queryKey }),
  });
  const query = useQuery({ ...erasurePreviewQuery(id, mode), enabled: !done.isSuccess });
  const submit = (event: FormEvent) => {
    event.preventDefault();
    done.mutate();
  };
  if (done.data)
    return (
      <Frame at="people" lead="Erase or anonymise a person.">
        <Notice title={`${done.data.mode === 'erase' ? 'Erased' : 'Anonymised'}.`}>
          The records now say “{done.data.alias}”. Files and old rows of the audit trail are finished in the background.
        </Notice>
        <p>
          <Link href="/network/people">Back to the accounts</Link>
        </p>
      </Frame>
    );
  return (
    <Frame at="people" lead="Erase or anonymise a person. This cannot be undone.">
      {query.isError ? (
        <Notice tone="bad" title="This person cannot be erased." onRetry={() => void query.refetch()}>
          {query.error.message}
        </Notice>
      ) : null}
      <Card title={query.data ? `Erase or anonymise ${query.data.name}` : 'Erase or anonymise'}>
        <div className={styles.stack}>
          <fieldset className={styles.choices}>
            <legend>What shall become of the trials?</legend>
            {kModes.map((one) => (
              <label key={one.mode}>
                <input type="radio" name="mode" checked={mode === one.mode} onChange={() => setMode(one.mode)} />
                <span>
                  <b>{one.name}</b> {one.text}
                </span>
              </label>
            ))}
          </fieldset>
          <p>
            <a href={dataOfAccountAddress(id)} download>
              Download this person’s data
            </a>{' '}
            before, if they ask for it.
          </p>
          {query.data ? <Counts preview={query.data} /> : null}
          <p className={styles.muted}>
            Older backups still hold this person until they are deleted. <code>tractus-server restore</code> erases
            everybody of the list <code>erasures.list</code> again, which lies beside the backups and in the data
            folder.
          </p>
          {done.error ? (
            <Notice tone="bad" title="The action failed.">
              {done.error.message}
            </Notice>
          ) : null}
          <form className={styles.form} onSubmit={submit}>
            <Field
              label="Type the name of the account to confirm"
              value={typed}
              autoComplete="off"
              onChange={(event) => setTyped(event.target.value)}
            />
            <Button look="solid" type="submit" disabled={done.isPending || !query.data || typed !== query.data.name}>
              {mode === 'erase' ? 'Erase' : 'Anonymise'}
            </Button>
          </form>
        </div>
      </Card>
    </Frame>
  );
}
