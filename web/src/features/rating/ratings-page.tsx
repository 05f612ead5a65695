import { useQuery } from '@tanstack/react-query';
import { useMemo } from 'react';
import { Link } from 'wouter';
import { ratingRequestsQuery, type ListedRequest } from '@/api';
import { marked, say } from '@/language';
import { Badge, Card, DataTable, Notice } from '@/ui';
import { formatCount, formatDateTime } from '@/units';
import { Frame } from './frame';

type State = 'open' | 'waiting' | 'complete';
const stateOf = ({ own, submitted, raters }: ListedRequest): State =>
  submitted >= raters ? 'complete' : own ? 'waiting' : 'open';
const kStates = {
  open: { tone: 'accent', words: marked('to rate') },
  waiting: { tone: 'neutral', words: marked('waits for others') },
  complete: { tone: 'good', words: marked('complete') },
} as const;
const kOrder: readonly State[] = ['open', 'waiting', 'complete'];

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
      lead={say(
        'Trials that you are asked to rate. Open a trial to rate it; ratings stay hidden until every rater has finished. To request ratings of another trial, open its debriefing.',
      )}
    >
      {query.isError ? (
        <Notice tone="bad" title={say('The list could not be loaded.')} onRetry={() => void query.refetch()}>
          {query.error.message}
        </Notice>
      ) : null}
      <Card title={say('Trials to rate')}>
        <DataTable<ListedRequest>
          address=""
          caption={say('Trials to rate')}
          minWidth={640}
          rows={rows}
          keyOf={({ trial_id, rubric_id }) => `${trial_id} ${rubric_id}`}
          empty={say('No trial is to be rated. Open a trial’s debriefing and have it rated.')}
          filter={{ label: say('Filter by case or rubric'), text: (one) => `${one.case_title} ${one.rubric_title}` }}
          columns={[
            {
              name: marked('Case'),
              by: ({ case_title }) => case_title,
              cell: ({ trial_id, case_title }) => <Link href={`/trials/${trial_id}/debrief`}>{case_title}</Link>,
            },
            {
              name: marked('Started'),
              by: ({ started_utc_us }) => started_utc_us,
              cell: ({ started_utc_us, simulated }) => (
                <>
                  {formatDateTime(started_utc_us)} {simulated ? <Badge tone="warn">{say('simulated')}</Badge> : null}
                </>
              ),
            },
            {
              name: marked('Rubric'),
              by: ({ rubric_title }) => rubric_title,
              cell: ({ rubric_title }) => rubric_title,
            },
            {
              name: marked('Name hidden'),
              by: ({ blind }) => (blind ? 0 : 1),
              cell: ({ blind }) => (blind ? say('yes') : say('no')),
            },
            {
              name: marked('Rated by'),
              by: ({ submitted }) => submitted,
              cell: ({ submitted, raters }) =>
                say('{submitted} of {raters}', { submitted: formatCount(submitted), raters: formatCount(raters) }),
            },
            {
              name: marked('State'),
              by: (one) => kOrder.indexOf(stateOf(one)),
              cell: (one) => <Badge tone={kStates[stateOf(one)].tone}>{say(kStates[stateOf(one)].words)}</Badge>,
            },
          ]}
        />
      </Card>
    </Frame>
  );
}
