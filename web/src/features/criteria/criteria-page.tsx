import { useMutation, useQuery, useQueryClient } from '@tanstack/react-query';
import { useState } from 'react';
import { Link } from 'wouter';
import {
  addCriteria,
  allAssignmentsQuery,
  allCasesQuery,
  criteriaOf,
  criteriaQuery,
  sessionQuery,
  type CriteriaEntry,
  type CriteriaVersion,
} from '@/api';
import { Badge, Button, Card, DataTable, Field, Notice, Select } from '@/ui';
import { formatCount, formatDateTime } from '@/units';
import styles from './criteria.module.css';
import { draftOf, newRequirement, requestOf, requirementProblem, type RequirementDraft } from './draft';
import { Frame } from './frame';
import { Requirements, useMetrics } from './parts';
import { RequirementsEditor } from './requirements-editor';

type Kind = CriteriaEntry['kind'];
const kKindNames: Record<Kind, string> = { programme: 'Whole programme', case: 'Case', assignment: 'Assignment' };
const nameOf = ({ kind, title }: CriteriaEntry) => (kind === 'programme' ? kKindNames.programme : title);

/** States a new version: of the programme, a case or an assignment. */
function Stating({ entries }: { readonly entries: readonly CriteriaEntry[] }) {
  const client = useQueryClient();
  const { unitOf } = useMetrics();
  const role = useQuery({ ...sessionQuery, enabled: false }).data?.role;
  const [kind, setKind] = useState<Kind>('assignment');
  const [subject, setSubject] = useState('');
  const [reason, setReason] = useState('');
  const [requirements, setRequirements] = useState<readonly RequirementDraft[]>([newRequirement('recognition')]);
  const cases = useQuery({ ...allCasesQuery, enabled: kind === 'case' }).data?.cases ?? [];
  const assignments = useQuery({ ...allAssignmentsQuery, enabled: kind === 'assignment' }).data?.assignments ?? [];
  const made = useMutation({
    mutationFn: () =>
      addCriteria(
        kind === 'programme' ? {} : { [kind]: subject },
        criteriaOf(requirements.map((one) => requestOf(one, unitOf))),
        reason.trim(),
      ),
    onSuccess: async (list) => {
      client.setQueryData(criteriaQuery.queryKey, list);
      setReason('');
      await client.invalidateQueries({ queryKey: ['passing'] });
      await client.invalidateQueries({ queryKey: ['trainees'] });
    },
  });
  const choose = (next: Kind, id: string) => {
    setKind(next);
    setSubject(id);
    const known = entries.find((one) => one.kind === next && one.subject === id)?.versions.at(-1);
    if (known) setRequirements(known.requirements.map((one) => draftOf(one, unitOf)));
  };
  const kinds = (Object.keys(kKindNames) as Kind[]).filter((one) => one !== 'programme' || role !== 'faculty');
  const items = kind === 'case' ? cases : assignments;
  const wrong =
    kind !== 'programme' && subject === ''
      ? `Choose the ${kind}.`
      : requirements.length === 0
        ? 'Add a requirement.'
        : (requirements.map(requirementProblem).find((one) => one !== '') ?? '');
  return (
    <Card title="Set criteria">
      <div className={styles.stack}>
        <div className={styles.form}>
          <Select
            label="Of"
            value={kind}
            onChange={(event) => choose(event.target.value as Kind, '')}
            options={kinds.map((value) => ({ value, text: kKindNames[value] }))}
          />
          {kind === 'programme' ? null : (
            <Select
              label={kKindNames[kind]}
              value={subject}
              onChange={(event) => choose(kind, event.target.value)}
              options={[
                { value: '', text: `Choose the ${kind}` },
                ...items.map(({ id, title }) => ({ value: id, text: title })),
              ]}
            />
          )}
          <Field
            label="Reason of the change (optional)"
            value={reason}
            maxLength={400}
            onChange={(event) => setReason(event.target.value)}
          />
        </div>
        <RequirementsEditor requirements={requirements} onRequirements={setRequirements} />
        {made.isError ? (
          <Notice tone="bad" title="The criteria were not stored.">
            {made.error.message}
          </Notice>
        ) : null}
        {made.isSuccess ? <p role="status">Stored as a new version.</p> : null}
        <div className={styles.go}>
          <span>{wrong}</span>
          <Button look="solid" disabled={wrong !== '' || made.isPending} onClick={() => made.mutate()}>
            Store as a new version
          </Button>
        </div>
      </div>
    </Card>
  );
}

function Versions({ of }: { readonly of: CriteriaEntry }) {
  const [newest, ...older] = [...of.versions].reverse();
  if (!newest) return null;
  const line = ({ version, made_utc_us, made_by, reason }: CriteriaVersion) =>
    `Version ${formatCount(version)}, ${formatDateTime(made_utc_us)} by ${made_by}${reason === '' ? '' : `: ${reason}`}`;
  return (
    <div className={styles.stack}>
      <Requirements of={newest.requirements} />
      <p className={styles.muted}>{line(newest)}</p>
      {older.length === 0 ? null : (
        <details>
          <summary>Earlier versions</summary>
          {older.map((one) => (
            <div key={one.version}>
              <p className={styles.muted}>{line(one)}</p>
              <Requirements of={one.requirements} />
            </div>
          ))}
        </details>
      )}
    </div>
  );
}

/** What passing is, of the programme, of cases and of assignments. */
export function CriteriaPage() {
  const query = useQuery(criteriaQuery);
  const entries = query.data?.criteria;
  const stated = entries?.some(({ kind }) => kind === 'programme');
  return (
    <Frame
      at="/criteria"
      lead="Requirements for passing. A trainee who has begun keeps the version that was valid then; a new version applies to those who begin later."
    >
      {query.isError ? (
        <Notice tone="bad" title="The criteria could not be loaded." onRetry={() => void query.refetch()}>
          {query.error.message}
        </Notice>
      ) : null}
      <Card title="Criteria">
        <div className={styles.stack}>
          {query.data && !stated ? (
            <Notice title="Default criteria, where none are set:">
              <Requirements of={query.data.usual} />
            </Notice>
          ) : null}
          <DataTable<CriteriaEntry>
            address=""
            caption="Criteria"
            minWidth={640}
            rows={entries}
            keyOf={({ kind, subject }) => `${kind} ${subject}`}
            empty="No criteria stated yet."
            filter={{ label: 'Filter by case or assignment', text: nameOf }}
            columns={[
              { name: 'Of', by: nameOf, cell: nameOf },
              { name: 'Kind', by: ({ kind }) => kind, cell: ({ kind }) => <Badge>{kKindNames[kind]}</Badge> },
              { name: 'Passing', cell: (one) => <Versions of={one} /> },
              {
                name: 'Who has passed',
                cell: ({ kind, subject }) =>
                  kind === 'programme' ? (
                    <Link href="/trainees">Trainees</Link>
                  ) : (
                    <Link href={`/criteria/${kind}/${subject}`}>Who has passed</Link>
                  ),
              },
            ]}
          />
        </div>
      </Card>
      {entries ? <Stating entries={entries} /> : null}
    </Frame>
  );
}
