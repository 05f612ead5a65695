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
import { Badge, Button, Card, DataTable, Field, Notice, Select, useSettled } from '@/ui';
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
      caption="Rows of the list"
      order="as in the list"
      minWidth={640}
      rows={rows}
      keyOf={({ line }) => String(line)}
      empty="The list has no rows."
      columns={[
        { name: 'Name', by: (row) => row.name, cell: (row) => row.name || '–' },
        { name: 'Line', by: (row) => row.line, cell: (row) => formatCount(row.line), number: true },
        { name: 'Role', by: (row) => row.role, cell: (row) => row.role },
        { name: 'Level', by: (row) => row.level, cell: (row) => row.level || '–' },
        { name: 'Badge', by: (row) => row.badge, cell: (row) => `${row.badge ?? '–'}${row.has_pin ? ', PIN' : ''}` },
        {
          name: 'Check',
          by: (row) => row.error,
          cell: (row) =>
            row.error === null ? <Badge tone="good">ready</Badge> : <Badge tone="bad">{row.error}</Badge>,
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
        label="CSV file"
        type="file"
        accept=".csv,.txt,text/csv"
        onChange={(event) => void take(event.target.files?.[0])}
      />
      <div className={styles.field}>
        <label htmlFor="class-list">Or paste the list; the first line names the columns</label>
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
        Columns: <strong>name</strong>, and optionally role (trainee if empty), level, badge and PIN (4 to 12 digits).
        At most 200 rows.
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
      <Frame at="/class" lead="All accounts were created.">
        <Cards cards={made.data.rows.map(({ name, password, badge }) => ({ name, password: password ?? '', badge }))} />
      </Frame>
    );
  return (
    <Frame
      at="/class"
      lead="Accounts for a whole class from a spreadsheet. The rows are checked first; then all accounts are created, or none."
    >
      <div className={styles.two}>
        <Card title="List">
          <List text={text} onText={setText} />
        </Card>
        <Card title="For all rows">
          <div className={styles.stack}>
            <Select
              label="Cohort"
              value={cohort}
              onChange={(event) => setCohort(event.target.value)}
              options={[
                { value: '', text: 'none' },
                ...(cohorts.data?.cohorts ?? []).map(({ id, name }) => ({ value: id, text: name })),
                { value: kNew, text: 'a new cohort…' },
              ]}
            />
            {cohort === kNew ? (
              <Field
                label="Name of the new cohort"
                value={newCohort}
                maxLength={100}
                onChange={(event) => setNewCohort(event.target.value)}
              />
            ) : null}
            <Field
              label="Level for rows without one (optional)"
              value={level}
              maxLength={64}
              placeholder="PGY-1"
              onChange={(event) => setLevel(event.target.value)}
            />
          </div>
        </Card>
      </div>
      {check.isError ? (
        <Notice tone="bad" title="The list cannot be read.">
          {check.error.message}
        </Notice>
      ) : null}
      {made.isError ? (
        <Notice tone="bad" title="No account was created.">
          {made.error.message}
        </Notice>
      ) : null}
      {made.data && !made.data.applied ? (
        <Notice tone="bad" title="No account was created.">
          The accounts here have changed since the list was checked. Check the rows again.
        </Notice>
      ) : null}
      {rows ? (
        <Card
          title="Check"
          aside={
            <span role="status" className={styles.muted}>
              {formatCount(rows.length)} {rows.length === 1 ? 'row' : 'rows'}
              {wrong > 0 ? `, ${formatCount(wrong)} with an error` : ', no errors'}
            </span>
          }
        >
          <div className={styles.stack}>
            <Preview rows={(made.data ?? check.data)?.rows ?? rows} />
            <div className={styles.go}>
              {wrong > 0 ? <span>Correct the rows with an error; until then nothing is created.</span> : null}
              <Button look="solid" disabled={!ready || made.isPending} onClick={() => made.mutate()}>
                {made.isPending ? 'Creating…' : `Create ${formatCount(rows.length)} accounts`}
              </Button>
            </div>
          </div>
        </Card>
      ) : null}
    </Frame>
  );
}
