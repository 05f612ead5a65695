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
import { marked, say, Sentence } from '@/language';
import { Badge, Button, Card, DataTable, Field, Notice } from '@/ui';
import { formatBytes, formatCount } from '@/units';
import { Frame } from './frame';
import styles from './network.module.css';

type Row = ErasurePreview['tables'][number];

const kFates = {
  removed: { text: marked('removed'), tone: 'bad' },
  changed: { text: marked('made anonymous'), tone: 'warn' },
  kept: { text: marked('kept'), tone: 'neutral' },
  none: { text: '', tone: 'neutral' },
} as const;

const kModes: readonly { readonly mode: ErasureMode; readonly name: string; readonly text: string }[] = [
  { mode: 'erase', name: marked('Erase'), text: marked('The account, its trials and their recordings are removed.') },
  {
    mode: 'anonymise',
    name: marked('Anonymise'),
    text: marked(
      'The account is removed. Trials and scores stay by a pseudonym that nothing links to the person any more.',
    ),
  },
];

function Counts({ preview }: { readonly preview: ErasurePreview }) {
  return (
    <>
      {preview.files > 0 ? (
        <p>
          {say('{count} recordings ({size}) are deleted from the disk.', {
            count: formatCount(preview.files),
            size: formatBytes(preview.file_bytes),
          })}{' '}
          {preview.open_uploads > 0
            ? say('A station is still uploading {count} of them: it is told.', {
                count: formatCount(preview.open_uploads),
              })
            : ''}
        </p>
      ) : null}
      <DataTable<Row>
        caption={say('What becomes of the records')}
        order={say('by area')}
        minWidth={640}
        rows={preview.tables}
        keyOf={({ table }) => table}
        empty={say('Nothing is recorded of this person.')}
        columns={[
          { name: marked('Records'), cell: (one) => say(one.what) },
          { name: marked('Rows'), cell: (one) => (one.fate === 'kept' ? '–' : formatCount(one.rows)), number: true },
          {
            name: marked('Afterwards'),
            cell: (one) => <Badge tone={kFates[one.fate].tone}>{say(kFates[one.fate].text)}</Badge>,
          },
          { name: marked('Why'), cell: (one) => say(one.reason) },
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
      <Frame at="people" lead={say('Erase or anonymise a person.')}>
        <Notice title={done.data.mode === 'erase' ? say('Erased.') : say('Anonymised.')}>
          {say('The records now say “{alias}”. Files and old rows of the audit trail are finished in the background.', {
            alias: done.data.alias,
          })}
        </Notice>
        <p>
          <Link href="/network/people">{say('Back to the accounts')}</Link>
        </p>
      </Frame>
    );
  return (
    <Frame at="people" lead={say('Erase or anonymise a person. This cannot be undone.')}>
      {query.isError ? (
        <Notice tone="bad" title={say('This person cannot be erased.')} onRetry={() => void query.refetch()}>
          {query.error.message}
        </Notice>
      ) : null}
      <Card
        title={query.data ? say('Erase or anonymise {name}', { name: query.data.name }) : say('Erase or anonymise')}
      >
        <div className={styles.stack}>
          <fieldset className={styles.choices}>
            <legend>{say('What shall become of the trials?')}</legend>
            {kModes.map((one) => (
              <label key={one.mode}>
                <input type="radio" name="mode" checked={mode === one.mode} onChange={() => setMode(one.mode)} />
                <span>
                  <b>{say(one.name)}</b> {say(one.text)}
                </span>
              </label>
            ))}
          </fieldset>
          <p>
            <Sentence
              text="<link>Download this person’s data</link> before, if they ask for it."
              parts={{
                link: (words) => (
                  <a href={dataOfAccountAddress(id)} download>
                    {words}
                  </a>
                ),
              }}
            />
          </p>
          {query.data ? <Counts preview={query.data} /> : null}
          <p className={styles.muted}>
            <Sentence
              text="Older backups still hold this person until they are deleted. <code>tractus-server restore</code> erases everybody of the list <code>erasures.list</code> again, which lies beside the backups and in the data folder."
              parts={{ code: (words) => <code>{words}</code> }}
            />
          </p>
          {done.error ? (
            <Notice tone="bad" title={say('The action failed.')}>
              {done.error.message}
            </Notice>
          ) : null}
          <form className={styles.form} onSubmit={submit}>
            <Field
              label={say('Type the name of the account to confirm')}
              value={typed}
              autoComplete="off"
              onChange={(event) => setTyped(event.target.value)}
            />
            <Button look="solid" type="submit" disabled={done.isPending || !query.data || typed !== query.data.name}>
              {mode === 'erase' ? say('Erase') : say('Anonymise')}
            </Button>
          </form>
        </div>
      </Card>
    </Frame>
  );
}
