import { useQuery } from '@tanstack/react-query';
import { useMemo } from 'react';
import { Link } from 'wouter';
import { rubricsQuery, sessionQuery, type Rubric } from '@/api';
import { marked, say } from '@/language';
import { Card, DataTable, Notice } from '@/ui';
import { formatCount, formatDate } from '@/units';
import { Frame } from './frame';
import styles from './rating.module.css';

/** The newest version of each rubric; versions come oldest first. */
const newest = (all: readonly Rubric[]) => [...new Map(all.map((one) => [one.id, one])).values()];

export function RubricsPage() {
  const query = useQuery(rubricsQuery);
  const role = useQuery({ ...sessionQuery, enabled: false }).data?.role;
  const rows = useMemo(() => query.data && newest(query.data.rubrics), [query.data]);
  const may = role === 'admin' || role === 'director';
  return (
    <Frame
      at="/ratings/rubrics"
      lead={say(
        'Forms for rating trials: items with points, described at both ends. A change makes a new version; earlier ratings keep theirs.',
      )}
    >
      {query.isError ? (
        <Notice tone="bad" title={say('The rubrics could not be loaded.')} onRetry={() => void query.refetch()}>
          {query.error.message}
        </Notice>
      ) : null}
      <Card
        title={say('Rubrics')}
        aside={
          may ? (
            <Link href="/ratings/rubrics/new" className={styles.solid}>
              {say('New rubric')}
            </Link>
          ) : undefined
        }
      >
        <DataTable<Rubric>
          address=""
          caption={say('Rubrics')}
          rows={rows}
          keyOf={({ id }) => id}
          empty={
            may ? say('No rubrics yet. Make a new rubric.') : say('No rubrics yet. A programme director makes them.')
          }
          filter={{ label: say('Filter by title'), text: ({ title }) => title }}
          columns={[
            {
              name: marked('Rubric'),
              by: ({ title }) => title,
              cell: ({ id, title }) => <Link href={`/ratings/rubrics/${id}`}>{title}</Link>,
            },
            {
              name: marked('Items'),
              by: ({ items }) => items.length,
              cell: ({ items }) => formatCount(items.length),
              number: true,
            },
            {
              name: marked('Version'),
              by: ({ version }) => version,
              cell: ({ version }) => formatCount(version),
              number: true,
            },
            {
              name: marked('Changed'),
              by: ({ made_utc_us }) => made_utc_us,
              cell: ({ made_utc_us, made_by }) =>
                say('{date} by {name}', { date: formatDate(made_utc_us), name: made_by }),
            },
          ]}
        />
      </Card>
    </Frame>
  );
}
