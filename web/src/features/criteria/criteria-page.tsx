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
import { marked, say } from '@/language';
import { Badge, Button, Card, DataTable, Field, Notice, Select } from '@/ui';
import { formatCount, formatDateTime } from '@/units';
import styles from './criteria.module.css';
import { draftOf, newRequirement, requestOf, requirementProblem, type RequirementDraft } from './draft';
import { Frame } from './frame';
import { Requirements, useMetrics } from './parts';
import { RequirementsEditor } from './requirements-editor';

type Kind = CriteriaEntry['kind'];
const kKindNames: Record<Kind, string> = {
  programme: marked('Whole programme'),
  case: marked('Case'),
  assignment: marked('Assignment'),
};
const nameOf = ({ kind, title }: CriteriaEntry) => (kind === 'programme' ? say(kKindNames.programme) : title);

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
      ? say('Choose the {kind}.', { kind })
      : requirements.length === 0
        ? say('Add a requirement.')
        : (requirements.map(requirementProblem).find((one) => one !== '') ?? '');
  return (
    <Card title={say('Set criteria')}>
      <div className={styles.stack}>
        <div className={styles.form}>
          <Select
            label={say('Of')}
            value={kind}
            onChange={(event) => choose(event.target.value as Kind, '')}
            options={kinds.map((value) => ({ value, text: say(kKindNames[value]) }))}
          />
          {kind === 'programme' ? null : (
            <Select
              label={say(kKindNames[kind])}
              value={subject}
              onChange={(event) => choose(kind, event.target.value)}
              options={[
                { value: '', text: say('Choose the {kind}', { kind }) },
                ...items.map(({ id, title }) => ({ value: id, text: title })),
              ]}
            />
          )}
          <Field
            label={say('Reason of the change (optional)')}
            value={reason}
            maxLength={400}
            onChange={(event) => setReason(event.target.value)}
          />
        </div>
        <RequirementsEditor requirements={requirements} onRequirements={setRequirements} />
        {made.isError ? (
          <Notice tone="bad" title={say('The criteria were not stored.')}>
            {made.error.message}
          </Notice>
        ) : null}
        {made.isSuccess ? <p role="status">{say('Stored as a new version.')}</p> : null}
        <div className={styles.go}>
          <span>{wrong}</span>
          <Button look="solid" disabled={wrong !== '' || made.isPending} onClick={() => made.mutate()}>
            {say('Store as a new version')}
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
    `${say('Version {version}, {time} by {name}', { version: formatCount(version), time: formatDateTime(made_utc_us), name: made_by })}${reason === '' ? '' : `: ${reason}`}`;
  return (
    <div className={styles.stack}>
      <Requirements of={newest.requirements} />
      <p className={styles.muted}>{line(newest)}</p>
      {older.length === 0 ? null : (
        <details>
          <summary>{say('Earlier versions')}</summary>
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
      lead={say(
        'Requirements for passing. A trainee who has begun keeps the version that was valid then; a new version applies to those who begin later.',
      )}
    >
      {query.isError ? (
        <Notice tone="bad" title={say('The criteria could not be loaded.')} onRetry={() => void query.refetch()}>
          {query.error.message}
        </Notice>
      ) : null}
      <Card title={say('Criteria')}>
        <div className={styles.stack}>
          {query.data && !stated ? (
            <Notice title={say('Default criteria, where none are set:')}>
              <Requirements of={query.data.usual} />
            </Notice>
          ) : null}
          <DataTable<CriteriaEntry>
            address=""
            caption={say('Criteria')}
            minWidth={640}
            rows={entries}
            keyOf={({ kind, subject }) => `${kind} ${subject}`}
            empty={say('No criteria stated yet.')}
            filter={{ label: say('Filter by case or assignment'), text: nameOf }}
            columns={[
              { name: say('Of'), by: nameOf, cell: nameOf },
              { name: say('Kind'), by: ({ kind }) => kind, cell: ({ kind }) => <Badge>{say(kKindNames[kind])}</Badge> },
              { name: say('Passing'), cell: (one) => <Versions of={one} /> },
              {
                name: say('Who has passed'),
                cell: ({ kind, subject }) =>
                  kind === 'programme' ? (
                    <Link href="/trainees">{say('Trainees')}</Link>
                  ) : (
                    <Link href={`/criteria/${kind}/${subject}`}>{say('Who has passed')}</Link>
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
