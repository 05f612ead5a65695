import { useQuery } from '@tanstack/react-query';
import { Link } from 'wouter';
import { curriculaQuery, type Curriculum } from '@/api';
import { say } from '@/language';
import { Card, DataTable, Notice } from '@/ui';
import { formatCount, formatDate } from '@/units';
import styles from './criteria.module.css';
import { Frame } from './frame';

/** The curricula of the programme. */
export function CurriculaPage() {
  const query = useQuery(curriculaQuery);
  const newest = ({ versions }: Curriculum) => versions.at(-1);
  return (
    <Frame
      at="/curricula"
      lead={say(
        'Ordered steps, each with its cases and its criteria. Stations offer a step when the steps before it are passed.',
      )}
    >
      {query.isError ? (
        <Notice tone="bad" title={say('The curricula could not be loaded.')} onRetry={() => void query.refetch()}>
          {query.error.message}
        </Notice>
      ) : null}
      <Card
        title={say('Curricula')}
        aside={
          <Link href="/curricula/new" className={styles.solid}>
            {say('New curriculum')}
          </Link>
        }
      >
        <DataTable<Curriculum>
          address=""
          caption={say('Curricula')}
          rows={query.data?.curricula}
          keyOf={({ id }) => id}
          empty={say('No curricula yet. Make a new curriculum.')}
          filter={{ label: say('Filter by title'), text: (one) => newest(one)?.title ?? '' }}
          columns={[
            {
              name: say('Curriculum'),
              by: (one) => newest(one)?.title,
              cell: (one) => <Link href={`/curricula/${one.id}`}>{newest(one)?.title}</Link>,
            },
            {
              name: say('Steps'),
              by: (one) => newest(one)?.steps.length,
              cell: (one) => formatCount(newest(one)?.steps.length ?? 0),
              number: true,
            },
            {
              name: say('Version'),
              by: (one) => one.versions.length,
              cell: (one) => formatCount(one.versions.length),
              number: true,
            },
            {
              name: say('Changed'),
              by: (one) => newest(one)?.made_utc_us,
              cell: (one) => {
                const version = newest(one);
                return version ? `${formatDate(version.made_utc_us)} by ${version.made_by}` : '–';
              },
            },
          ]}
        />
      </Card>
    </Frame>
  );
}
