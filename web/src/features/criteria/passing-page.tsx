import { useQuery } from '@tanstack/react-query';
import { Link } from 'wouter';
import { criteriaQuery, passingQuery, type PersonPassing } from '@/api';
import { Badge, Card, DataTable, Notice, useTitle } from '@/ui';
import { formatCount, formatDate } from '@/units';
import styles from './criteria.module.css';
import { Judged } from './parts';

const standing = ({ passed, holds_now }: PersonPassing) =>
  passed ? (holds_now ? 'passed' : 'passed, not met now') : 'not passed';

/** Who has passed a case or an assignment, by which version. */
export function PassingPage({ kind, id }: { readonly kind: 'case' | 'assignment'; readonly id: string }) {
  const query = useQuery(passingQuery(kind, id));
  const criteria = useQuery(criteriaQuery).data?.criteria;
  const title = criteria?.find((one) => one.kind === kind && one.subject === id)?.title ?? kind;
  useTitle(`Who has passed: ${title}`);
  return (
    <div className={styles.page}>
      <p>
        <Link href="/criteria">← Criteria</Link>
      </p>
      <h1>Who has passed: {title}</h1>
      {query.isError ? (
        <Notice tone="bad" title="This could not be loaded." onRetry={() => void query.refetch()}>
          {query.error.message}
        </Notice>
      ) : null}
      <Card title="People">
        <DataTable<PersonPassing>
          address=""
          caption="People"
          minWidth={640}
          rows={query.data?.people}
          keyOf={({ name }) => name}
          empty="Nobody has a trial that counts yet."
          filter={{ label: 'Filter by name', text: ({ name }) => name }}
          columns={[
            {
              name: 'Name',
              by: ({ name }) => name,
              cell: ({ name, simulated }) => (
                <>
                  <Link href={`/trainees/${encodeURIComponent(name)}`}>{name}</Link>{' '}
                  {simulated ? <Badge tone="warn">simulated</Badge> : null}
                </>
              ),
            },
            {
              name: 'State',
              by: standing,
              cell: (one) => (
                <Badge tone={one.passed ? (one.holds_now ? 'good' : 'warn') : 'neutral'}>{standing(one)}</Badge>
              ),
            },
            {
              name: 'Since',
              by: ({ passed_utc_us }) => passed_utc_us,
              cell: ({ passed_utc_us }) => (passed_utc_us === null ? '–' : formatDate(passed_utc_us)),
            },
            { name: 'Trials', by: ({ trials }) => trials, cell: ({ trials }) => formatCount(trials), number: true },
            { name: 'Requirements', cell: ({ requirements }) => <Judged of={requirements} /> },
            {
              name: 'Version',
              by: ({ version }) => version,
              cell: ({ version }) => (version === 0 ? 'usual' : formatCount(version)),
            },
          ]}
        />
      </Card>
    </div>
  );
}
