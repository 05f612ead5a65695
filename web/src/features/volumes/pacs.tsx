/** Volumes from the hospital's PACS: find a study, choose a series, import it. Shown where a PACS is stated. */
import { useMutation, useQuery, useQueryClient } from '@tanstack/react-query';
import { useEffect, useState, type FormEvent } from 'react';
import { Link } from 'wouter';
import {
  findPacsStudies,
  importPacsSeries,
  pacsBegunQuery,
  pacsImportQuery,
  pacsQuery,
  pacsSeriesQuery,
  sourceVolumesQuery,
  type PacsSearch,
  type PacsSeries,
  type PacsStudy,
} from '@/api';
import { marked, say } from '@/language';
import { Button, Card, DataTable, Field, Notice } from '@/ui';
import { formatBytes, formatCount, formatDate, kNone, utcMicroseconds } from '@/units';
import { SeriesTable } from './series-table';
import styles from './volumes.module.css';

const kStudiesOfPage = 50;
const counted = (value: number | null) => (value === null ? kNone : formatCount(value));
/** A day as the PACS writes it, 2024-03-14, in the reader's words. */
const day = (date: string | null) =>
  date === null ? kNone : formatDate(utcMicroseconds(1000 * Date.parse(`${date}T12:00`)));

interface Chosen {
  readonly study: PacsStudy;
  readonly series: PacsSeries;
}

/** How far an import is, and what became of it. */
function Importing({ id }: { readonly id: string }) {
  const client = useQueryClient();
  const query = useQuery(pacsImportQuery(id));
  const seen = query.data;
  const done = seen?.state === 'done';
  useEffect(() => {
    if (done) void client.invalidateQueries({ queryKey: sourceVolumesQuery.queryKey });
  }, [client, done]);
  if (query.isError)
    return (
      <Notice tone="bad" title={say('The import could not be followed.')} onRetry={() => void query.refetch()}>
        {query.error.message}
      </Notice>
    );
  if (seen?.state === 'failed')
    return (
      <Notice tone="bad" title={say('The series was not imported.')}>
        {seen.error}
      </Notice>
    );
  if (seen?.state === 'done' && seen.volume !== null)
    return (
      <Notice title={say('The series is imported and waits for review.')}>
        <Link href={`/volumes/${seen.volume}`}>{say('Look at the volume')}</Link>
      </Notice>
    );
  return (
    <p role="status">
      {seen?.state === 'reading'
        ? say('The server reads the volume and takes the patient’s identity out…')
        : say('The server fetches the series: {count, plural, one {# file} other {# files}}, {size}', {
            count: seen?.files ?? 0,
            size: formatBytes(seen?.size_bytes ?? 0),
          })}
    </p>
  );
}

/** Names the volume and begins the import. */
function Import({ study, series }: Chosen) {
  const [name, setName] = useState('');
  const [source, setSource] = useState('');
  const client = useQueryClient();
  const begun = useMutation({
    mutationFn: importPacsSeries,
    onSuccess: ({ id }, wish) =>
      client.setQueryData(pacsBegunQuery.queryKey, (others = []) => [{ id, name: wish.name }, ...others]),
  });
  return (
    <div className={styles.stack}>
      <div className={styles.form}>
        <Field
          label={say('Name, without a patient’s name')}
          value={name}
          maxLength={200}
          onChange={(event) => setName(event.target.value)}
        />
        <Field
          label={say('Origin and licence (optional)')}
          value={source}
          maxLength={400}
          onChange={(event) => setSource(event.target.value)}
        />
        <Button
          look="solid"
          disabled={name.trim() === '' || begun.isPending}
          onClick={() =>
            begun.mutate({
              study_uid: study.uid,
              series_uid: series.uid,
              name: name.trim(),
              source: source.trim(),
            })
          }
        >
          {say('Import')}
        </Button>
      </div>
      {begun.isError ? (
        <Notice tone="bad" title={say('The series was not imported.')}>
          {begun.error.message}
        </Notice>
      ) : null}
    </div>
  );
}

/** What was begun on this visit, each with the name of its volume. */
function Begun() {
  const begun = useQuery(pacsBegunQuery);
  return begun.data?.map(({ id, name }) => (
    <div key={id} className={styles.stack}>
      <strong>{name}</strong>
      <Importing id={id} />
    </div>
  ));
}

function SeriesOf({ study }: { readonly study: PacsStudy }) {
  const query = useQuery(pacsSeriesQuery(study.uid));
  const [chosen, setChosen] = useState<PacsSeries | null>(null);
  if (query.isError)
    return (
      <Notice tone="bad" title={say('The series could not be loaded.')} onRetry={() => void query.refetch()}>
        {query.error.message}
      </Notice>
    );
  return (
    <>
      <SeriesTable series={query.data?.series} chosen={chosen?.uid ?? null} onChoose={setChosen} />
      {chosen ? <Import key={chosen.uid} study={study} series={chosen} /> : null}
    </>
  );
}

const kNoSearch = { patient_id: '', from: '', to: '', description: '' };

/** Without the fields that are empty. */
const searchFrom = (fields: typeof kNoSearch): PacsSearch =>
  Object.fromEntries(
    Object.entries(fields)
      .map(([name, text]) => [name, text.trim()])
      .filter(([, text]) => text !== ''),
  );

function Search({ onSearch, busy }: { readonly onSearch: (search: PacsSearch) => void; readonly busy: boolean }) {
  const [fields, setFields] = useState(kNoSearch);
  const field = (name: keyof typeof kNoSearch, label: string, type = 'text') => (
    <Field
      label={label}
      type={type}
      value={fields[name]}
      maxLength={64}
      autoComplete="off"
      onChange={(event) => setFields({ ...fields, [name]: event.target.value })}
    />
  );
  const search = searchFrom(fields);
  return (
    <form
      className={styles.form}
      onSubmit={(event: FormEvent) => {
        event.preventDefault();
        onSearch(search);
      }}
    >
      {field('patient_id', say('Patient’s id'))}
      {field('from', say('First day'), 'date')}
      {field('to', say('Last day'), 'date')}
      {field('description', say('Part of the description'))}
      <Button look="solid" type="submit" disabled={busy || Object.keys(search).length === 0}>
        {say('Search')}
      </Button>
    </form>
  );
}

/** The panel; nothing where no PACS is stated. */
export function FromPacs() {
  const pacs = useQuery(pacsQuery);
  const [asked, setAsked] = useState<PacsSearch>({});
  const [study, setStudy] = useState<PacsStudy | null>(null);
  const found = useMutation({
    mutationFn: findPacsStudies,
    onMutate: (search) => {
      setAsked(search);
      setStudy(null);
    },
  });
  if (!pacs.data?.address) return null;
  const offset = asked.offset ?? 0;
  const turn = (to: number) => found.mutate({ ...asked, offset: to });
  return (
    <Card title={say('From a PACS')}>
      <div className={styles.stack}>
        <p className={styles.muted}>
          {say('Searches {address}. The audit trail notes who searches, not for whom.', {
            address: pacs.data.address,
          })}
        </p>
        <Search onSearch={found.mutate} busy={found.isPending} />
        {found.isError ? (
          <Notice tone="bad" title={say('The search failed.')}>
            {found.error.message}
          </Notice>
        ) : null}
        {found.isPending || found.data ? (
          <DataTable<PacsStudy>
            caption={say('Studies in the PACS')}
            minWidth={560}
            rows={found.data?.studies}
            keyOf={({ uid }) => uid}
            empty={say('No study fits.')}
            pageSize={kStudiesOfPage}
            columns={[
              { name: marked('Day'), by: ({ date }) => date, cell: ({ date }) => day(date) },
              {
                name: marked('Description'),
                by: ({ description }) => description,
                cell: ({ description }) => (description === '' ? kNone : description),
              },
              { name: marked('Modality'), cell: ({ modalities }) => modalities.join(', ') },
              {
                name: marked('Series'),
                by: ({ series }) => series,
                cell: ({ series }) => counted(series),
                number: true,
              },
              { name: marked('Files'), by: ({ files }) => files, cell: ({ files }) => counted(files), number: true },
              {
                name: marked('Choose'),
                cell: (one) => (
                  <Button aria-pressed={one.uid === study?.uid} onClick={() => setStudy(one)}>
                    {say('Show its series')}
                  </Button>
                ),
              },
            ]}
          />
        ) : null}
        {offset > 0 || found.data?.more ? (
          <div className={styles.buttons}>
            <Button
              disabled={offset === 0 || found.isPending}
              onClick={() => turn(Math.max(0, offset - kStudiesOfPage))}
            >
              {say('Studies before')}
            </Button>
            <Button disabled={!found.data?.more || found.isPending} onClick={() => turn(offset + kStudiesOfPage)}>
              {say('More studies')}
            </Button>
          </div>
        ) : null}
        {study ? <SeriesOf key={study.uid} study={study} /> : null}
        <Begun />
      </div>
    </Card>
  );
}
