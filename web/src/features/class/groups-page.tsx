import { useMutation, useQuery, useQueryClient } from '@tanstack/react-query';
import { useState } from 'react';
import { cohortsQuery, groupRulesQuery, kGroupRoles, setGroupRule, type GroupLine } from '@/api';
import { say } from '@/language';
import { Button, Card, Field, Notice, roleName, Select } from '@/ui';
import { formatCount, formatDateTime } from '@/units';
import styles from './class.module.css';
import { Frame } from './frame';

const kNewLine: GroupLine = { group: '', role: 'trainee', cohorts: [], level: '' };
const joins = (role: string) => role === 'trainee' || role === 'faculty';

function Line({
  number,
  line,
  cohorts,
  onChange,
  onRemove,
}: {
  readonly number: number;
  readonly line: GroupLine;
  readonly cohorts: readonly { readonly id: string; readonly name: string }[];
  readonly onChange: (line: GroupLine) => void;
  readonly onRemove: () => void;
}) {
  return (
    <fieldset className={styles.line}>
      <legend>{say('Line {number}', { number: formatCount(number) })}</legend>
      <Field
        label={say('Group, as the provider names it')}
        value={line.group}
        maxLength={200}
        onChange={(event) => onChange({ ...line, group: event.target.value })}
      />
      <Select
        label={say('Role')}
        value={line.role}
        options={kGroupRoles.map((role) => ({ value: role, text: roleName(role) }))}
        onChange={(event) => {
          const role = event.target.value;
          onChange({ ...line, role, cohorts: joins(role) ? line.cohorts : [] });
        }}
      />
      <Select
        label={say('Cohort')}
        value={line.cohorts[0] ?? ''}
        disabled={!joins(line.role)}
        options={[{ value: '', text: say('none') }, ...cohorts.map(({ id, name }) => ({ value: id, text: name }))]}
        onChange={(event) => onChange({ ...line, cohorts: event.target.value === '' ? [] : [event.target.value] })}
      />
      <Field
        label={say('Level (optional)')}
        value={line.level}
        maxLength={64}
        onChange={(event) => onChange({ ...line, level: event.target.value })}
      />
      <Button look="quiet" onClick={onRemove} label={say('Remove line {number}', { number: formatCount(number) })}>
        {say('Remove')}
      </Button>
    </fieldset>
  );
}

/** What holds from the next sign-in on. */
function RuleForm({
  lines: before,
  absentDays,
}: {
  readonly lines: readonly GroupLine[];
  readonly absentDays: number | undefined;
}) {
  const client = useQueryClient();
  const cohorts = useQuery(cohortsQuery).data?.cohorts ?? [];
  const [lines, setLines] = useState<readonly GroupLine[]>(before);
  const [days, setDays] = useState(absentDays === undefined ? '' : String(absentDays));
  const [reason, setReason] = useState('');
  const stored = useMutation({
    mutationFn: setGroupRule,
    onSuccess: (answer) => {
      client.setQueryData(groupRulesQuery.queryKey, answer);
      setReason('');
    },
  });
  const whole = lines.every(({ group }) => group.trim() !== '');
  return (
    <Card title={say('Rule')}>
      <div className={styles.stack}>
        {lines.map((line, at) => (
          <Line
            // Lines have no name of their own: their place is what they are.
            key={at}
            number={at + 1}
            line={line}
            cohorts={cohorts}
            onChange={(changed) => setLines(lines.map((one, i) => (i === at ? changed : one)))}
            onRemove={() => setLines(lines.filter((_, i) => i !== at))}
          />
        ))}
        <Button onClick={() => setLines([...lines, kNewLine])}>{say('Add a line')}</Button>
        <Field
          label={say('Disable whom the provider has not vouched for in so many days (optional)')}
          type="number"
          min={1}
          max={3650}
          value={days}
          onChange={(event) => setDays(event.target.value)}
        />
        <Field
          label={say('Reason')}
          value={reason}
          maxLength={500}
          onChange={(event) => setReason(event.target.value)}
        />
        {stored.isError ? (
          <Notice tone="bad" title={say('The rule was not stored.')}>
            {stored.error.message}
          </Notice>
        ) : null}
        <Button
          look="solid"
          disabled={!whole || reason.trim() === '' || stored.isPending}
          onClick={() => stored.mutate({ lines, absent_days: days === '' ? null : Number(days), reason })}
        >
          {say('Store as a new version')}
        </Button>
      </div>
    </Card>
  );
}

/** Accounts made, changed and disabled by the groups of the identity provider. */
export function GroupsPage() {
  const query = useQuery(groupRulesQuery);
  const newest = query.data?.versions[0];
  return (
    <Frame
      at="/class/groups"
      lead={say(
        'Whoever signs in with the identity provider gets role, cohort and level by the first line whose group has them; without a line, no account. An account that the rule made is disabled once no line fits. Administrators, and accounts that you make or disable by hand, are left alone.',
      )}
    >
      {query.isError ? (
        <Notice tone="bad" title={say('The rule could not be loaded.')} onRetry={() => void query.refetch()}>
          {query.error.message}
        </Notice>
      ) : null}
      {query.data ? (
        <RuleForm key={newest?.version ?? 0} lines={newest?.rule.lines ?? []} absentDays={newest?.rule.absent_days} />
      ) : null}
      <Card title={say('Versions')}>
        {query.data?.versions.length === 0 ? (
          <p>{say('No rule yet: an administrator links each account by hand.')}</p>
        ) : null}
        <ul className={styles.versions}>
          {query.data?.versions.map(({ version, rule, reason, made_utc_us, made_by }) => (
            <li key={version}>
              {say('Version {version}, {time}, {name}: {count, plural, one {# line} other {# lines}}. {reason}', {
                version: formatCount(version),
                time: formatDateTime(made_utc_us),
                name: made_by,
                count: rule.lines.length,
                reason,
              })}
            </li>
          ))}
        </ul>
      </Card>
    </Frame>
  );
}
