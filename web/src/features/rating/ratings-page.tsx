import { useQuery } from '@tanstack/react-query';
import { useMemo } from 'react';
import { Link } from 'wouter';
import { ratingRequestsQuery, type ListedRequest } from '@/api';
import { Badge, Card, DataTable, Notice } from '@/ui';
import { formatCount, formatDateTime } from '@/units';
import { Frame } from './frame';

type State = 'to rate' | 'waits for others' | 'complete';
const stateOf = ({ own, submitted, raters }: ListedRequest): State =>
  submitted >= raters ? 'complete' : own ? 'waits for others' : 'to rate';
const kTones = { 'to rate': 'accent', 'waits for others': 'neutral', complete: 'good' } as const;
const kOrder: readonly State[] = ['to rate', 'waits for others', 'complete'];

/** Trials that are to be rated, those that wait for the caller first. */
export function RatingsPage() {
  const query = useQuery(ratingRequestsQuery);
  const rows = useMemo(
    () => query.data?.requests.toSorted((a, b) => kOrder.indexOf(stateOf(a)) - kOrder.indexOf(stateOf(b))),
    [query.data],
  );
  return (
    <Frame
      at="/ratings"
      lead="Trials that you are asked to rate. Open a trial to rate it; ratings stay hidden until every rater has finished. To request ratings of another trial, open its debriefing."
    >
      {query.isError ? (
        <Notice tone="bad" title="The list could not be loaded." onRetry={() => void query.refetch()}>
          {query.error.message}
        </Notice>
      ) : null}
      <Card title="Trials to rate">
        <DataTable<ListedRequest>
          address=""
          caption="Trials to rate"
          minWidth={640}
          rows={rows}
          keyOf={({ trial_id, rubric_id }) => `${trial_id} ${rubric_id}`}
          empty="No trial is to be rated. Open a trial’s debriefing and have it rated."
          filter={{ label: 'Filter by case or rubric', text: (one) => `${one.case_title} ${one.rubric_title}` }}
          columns={[
            {
              name: 'Case',
              by: ({ case_title }) => case_title,
              cell: ({ trial_id, case_title }) => <Link href={`/trials/${trial_id}/debrief`}>{case_title}</Link>,
            },
            {
              name: 'Started',
              by: ({ started_utc_us }) => started_utc_us,
              cell: ({ started_utc_us, simulated }) => (
                <>
                  {formatDateTime(started_utc_us)} {simulated ? <Badge tone="warn">simulated</Badge> : null}
                </>
              ),
            },
            { name: 'Rubric', by: ({ rubric_title }) => rubric_title, cell: ({ rubric_title }) => rubric_title },
            {
              name: 'Name hidden',
              by: ({ blind }) => (blind ? 0 : 1),
              cell: ({ blind }) => (blind ? 'yes' : 'no'),
            },
            {
              name: 'Rated by',
              by: ({ submitted }) => submitted,
              cell: ({ submitted, raters }) => `${formatCount(submitted)} of ${formatCount(raters)}`,
            },
            {
              name: 'State',
              by: (one) => kOrder.indexOf(stateOf(one)),
              cell: (one) => <Badge tone={kTones[stateOf(one)]}>{stateOf(one)}</Badge>,
            },
          ]}
        />
      </Card>
    </Frame>
  );
}
