import { useMutation, useQuery, useQueryClient } from '@tanstack/react-query';
import { useState } from 'react';
import {
  allAccountsQuery,
  addCohort,
  classCheckQuery,
  cohortsQuery,
  importClass,
  type ClassList,
  type ImportRow,
} from '@/api';
import { marked, say, Sentence } from '@/language';
import { Badge, Button, Card, DataTable, Field, Notice, roleName, Select, useSettled } from '@/ui';
import { formatCount } from '@/units';
import { Cards } from './cards';
import styles from './class.module.css';
import { Frame } from './frame';
import { kExample, plainList } from './list';

const kNew = 'new';

/** The rows as they would be made, with what is wrong with each. */
function Preview({ rows }: { readonly rows: readonly ImportRow[] }) {
  return (
    <DataTable<ImportRow>
      caption={say('Rows of the list')}
      order={say('as in the list')}
      minWidth={640}
      rows={rows}
      keyOf={({ line }) => String(line)}
      empty={say('The list has no rows.')}
      columns={[
        { name: marked('Name'), by: (row) => row.name, cell: (row) => row.name || '–' },
        { name: marked('Line'), by: (row) => row.line, cell: (row) => formatCount(row.line), number: true },
        { name: marked('Role'), by: (row) => roleName(row.role), cell: (row) => roleName(row.role) },
        { name: marked('Level'), by: (row) => row.level, cell: (row) => row.level || '–' },
        {
          name: marked('Badge'),
          by: (row) => row.badge,
          cell: (row) => `${row.badge ?? '–'}${row.has_pin ? `, ${say('PIN')}` : ''}`,
        },
        {
          name: marked('Check'),
          by: (row) => row.error,
          cell: (row) =>
            row.error === null ? <Badge tone="good">{say('ready')}</Badge> : <Badge tone="bad">{say(row.error)}</Badge>,
        },
      ]}
    />
  );
}

function List({ text, onText }: { readonly text: string; readonly onText: (next: string) => void }) {
  const take = async (file: File | undefined) => {
    if (file) onText(await file.text());
  };
  return (
    <div className={styles.stack}>
      <Field
        label={say('CSV file')}
        type="file"
        accept=".csv,.txt,text/csv"
        onChange={(event) => void take(event.target.files?.[0])}
      />
      <div className={styles.field}>
        <label htmlFor="class-list">{say('Or paste the list; the first line names the columns')}</label>
        <textarea
          id="class-list"
          rows={8}
          spellCheck={false}
          value={text}
          placeholder={kExample}
          onChange={(event) => onText(event.target.value)}
        />
      </div>
      <p className={styles.muted}>
        <Sentence
          text="Columns: <strong>name</strong>, and optionally role (trainee if empty), level, badge and PIN (4 to 12 digits). At most 200 rows."
          parts={{ strong: (words) => <strong>{words}</strong> }}
        />
      </p>
    </div>
  );
}

/** Residents from a spreadsheet: checked row by row, then all accounts are created or none. */
export function ImportPage() {
  const client = useQueryClient();
  const cohorts = useQuery(cohortsQuery);
  const [text, setText] = useState('');
  const [cohort, setCohort] = useState('');
  const [newCohort, setNewCohort] = useState('');
  const [level, setLevel] = useState('');
  const settled = useSettled(text, 300);
  const list: ClassList = {
    csv: settled.trim() === '' ? '' : plainList(settled),
    cohort: cohort === kNew ? '' : cohort,
    level: level.trim(),
  };
  const check = useQuery(classCheckQuery(list));
  const made = useMutation({
    mutationFn: async () => {
      const into = cohort === kNew ? (await addCohort(newCohort.trim())).id : cohort;
      return importClass({ ...list, cohort: into });
    },
    onSuccess: async () => {
      await client.invalidateQueries({ queryKey: allAccountsQuery.queryKey });
      await client.invalidateQueries({ queryKey: cohortsQuery.queryKey });
    },
  });
  const rows = check.data?.rows;
  const wrong = rows?.filter(({ error }) => error !== null).length ?? 0;
  const ready =
    rows !== undefined && rows.length > 0 && wrong === 0 && !check.isFetching && (cohort !== kNew || newCohort.trim());
  if (made.data?.applied)
    return (
      <Frame at="/class" lead={say('All accounts were created.')}>
        <Cards cards={made.data.rows.map(({ name, password, badge }) => ({ name, password: password ?? '', badge }))} />
      </Frame>
    );
  return (
    <Frame
      at="/class"
      lead={say(
        'Accounts for a whole class from a spreadsheet. The rows are checked first; then all accounts are created, or none.',
      )}
    >
      <div className={styles.two}>
        <Card title={say('List')}>
          <List text={text} onText={setText} />
        </Card>
        <Card title={say('For all rows')}>
          <div className={styles.stack}>
            <Select
              label={say('Cohort')}
              value={cohort}
              onChange={(event) => setCohort(event.target.value)}
              options={[
                { value: '', text: say('none') },
                ...(cohorts.data?.cohorts ?? []).map(({ id, name }) => ({ value: id, text: name })),
                { value: kNew, text: say('a new cohort…') },
              ]}
            />
            {cohort === kNew ? (
              <Field
                label={say('Name of the new cohort')}
                value={newCohort}
                maxLength={100}
                onChange={(event) => setNewCohort(event.target.value)}
              />
            ) : null}
            <Field
              label={say('Level for rows without one (optional)')}
              value={level}
              maxLength={64}
              placeholder={say('PGY-1')}
              onChange={(event) => setLevel(event.target.value)}
            />
          </div>
        </Card>
      </div>
      {check.isError ? (
        <Notice tone="bad" title={say('The list cannot be read.')}>
          {check.error.message}
        </Notice>
      ) : null}
      {made.isError ? (
        <Notice tone="bad" title={say('No account was created.')}>
          {made.error.message}
        </Notice>
      ) : null}
      {made.data && !made.data.applied ? (
        <Notice tone="bad" title={say('No account was created.')}>
          {say('The accounts here have changed since the list was checked. Check the rows again.')}
        </Notice>
      ) : null}
      {rows ? (
        <Card
          title={say('Check')}
          aside={
            <span role="status" className={styles.muted}>
              {wrong > 0
                ? say('{count, plural, one {# row} other {# rows}}, {wrong} with an error', {
                    count: rows.length,
                    wrong: formatCount(wrong),
                  })
                : say('{count, plural, one {# row} other {# rows}}, no errors', { count: rows.length })}
            </span>
          }
        >
          <div className={styles.stack}>
            <Preview rows={(made.data ?? check.data)?.rows ?? rows} />
            <div className={styles.go}>
              {wrong > 0 ? <span>{say('Correct the rows with an error; until then nothing is created.')}</span> : null}
              <Button look="solid" disabled={!ready || made.isPending} onClick={() => made.mutate()}>
                {made.isPending
                  ? say('Creating…')
                  : say('Create {count, plural, one {# account} other {# accounts}}', { count: rows.length })}
              </Button>
            </div>
          </div>
        </Card>
      ) : null}
    </Frame>
  );
}
