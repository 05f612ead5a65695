import { useQuery } from '@tanstack/react-query';
import { Link } from 'wouter';
import { criteriaQuery, passingQuery, type PersonPassing } from '@/api';
import { say } from '@/language';
import { Badge, Card, DataTable, Notice, useTitle } from '@/ui';
import { formatCount, formatDate } from '@/units';
import styles from './criteria.module.css';
import { Judged } from './parts';

const standing = ({ passed, holds_now }: PersonPassing) =>
  passed ? (holds_now ? say('passed') : say('passed, not met now')) : say('not passed');

/** Who has passed a case or an assignment, by which version. */
export function PassingPage({ kind, id }: { readonly kind: 'case' | 'assignment'; readonly id: string }) {
  const query = useQuery(passingQuery(kind, id));
  const criteria = useQuery(criteriaQuery).data?.criteria;
  const title = criteria?.find((one) => one.kind === kind && one.subject === id)?.title ?? kind;
  useTitle(say('Who has passed: {title}', { title }));
  return (
    <div className={styles.page}>
      <p>
        <Link href="/criteria">← {say('Criteria')}</Link>
      </p>
      <h1>{say('Who has passed: {title}', { title })}</h1>
      {query.isError ? (
        <Notice tone="bad" title={say('This could not be loaded.')} onRetry={() => void query.refetch()}>
          {query.error.message}
        </Notice>
      ) : null}
      <Card title={say('People')}>
        <DataTable<PersonPassing>
          address=""
          caption={say('People')}
          minWidth={640}
          rows={query.data?.people}
          keyOf={({ name }) => name}
          empty={say('Nobody has a trial that counts yet.')}
          filter={{ label: say('Filter by name'), text: ({ name }) => name }}
          columns={[
            {
              name: say('Name'),
              by: ({ name }) => name,
              cell: ({ name, simulated }) => (
                <>
                  <Link href={`/trainees/${encodeURIComponent(name)}`}>{name}</Link>{' '}
                  {simulated ? <Badge tone="warn">{say('simulated')}</Badge> : null}
                </>
              ),
            },
            {
              name: say('State'),
              by: standing,
              cell: (one) => (
                <Badge tone={one.passed ? (one.holds_now ? 'good' : 'warn') : 'neutral'}>{standing(one)}</Badge>
              ),
            },
            {
              name: say('Since'),
              by: ({ passed_utc_us }) => passed_utc_us,
              cell: ({ passed_utc_us }) => (passed_utc_us === null ? '–' : formatDate(passed_utc_us)),
            },
            {
              name: say('Trials'),
              by: ({ trials }) => trials,
              cell: ({ trials }) => formatCount(trials),
              number: true,
            },
            { name: say('Requirements'), cell: ({ requirements }) => <Judged of={requirements} /> },
            {
              name: say('Version'),
              by: ({ version }) => version,
              cell: ({ version }) => (version === 0 ? 'usual' : formatCount(version)),
            },
          ]}
        />
      </Card>
    </div>
  );
}
