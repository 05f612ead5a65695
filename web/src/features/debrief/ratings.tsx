import { useMutation, useQuery, useQueryClient } from '@tanstack/react-query';
import { useState } from 'react';
import {
  askForRating,
  ratingRequestsQuery,
  rubricsQuery,
  trialQuery,
  trialRatingsQuery,
  withdrawRatingRequest,
  type Rating,
  type RatingRequest,
} from '@/api';
import { say } from '@/language';
import { Badge, Button, Card, Notice, Select, Skeleton, Table } from '@/ui';
import { formatCount, formatDateTime } from '@/units';
import { RatingForm } from './rating-form';
import styles from './rating.module.css';

interface Row {
  readonly label: string;
  readonly points: readonly number[];
}

function Given({ request }: { readonly request: RatingRequest }) {
  const held = request.ratings.filter(({ holds }) => holds);
  const earlier = request.ratings.filter(({ holds }) => !holds);
  if (held.length === 0) return null;
  const rows: Row[] = [
    ...request.rubric.items.map(({ label }, i) => ({ label, points: held.map(({ scores }) => scores[i] ?? 0) })),
    { label: say('Sum'), points: held.map(({ total }) => total) },
  ];
  const line = ({ rater, made_utc_us, scores, total, reason }: Rating) =>
    `${rater}, ${formatDateTime(made_utc_us)}: ${scores.map((one) => formatCount(one)).join(', ')} (sum ${formatCount(total)})${reason === '' ? '' : `; ${say('reason: {reason}', { reason })}`}`;
  return (
    <>
      <Table<Row>
        caption={say('Ratings by {title}', { title: request.rubric.title })}
        rows={rows}
        keyOf={({ label }, i) => `${i} ${label}`}
        empty=""
        columns={[
          { name: say('Item'), cell: ({ label }) => label },
          ...held.map(({ rater }, i) => ({
            name: <>{rater}</>, // a name is said in no language
            cell: ({ points }: Row) => formatCount(points[i] ?? 0),
            number: true,
          })),
        ]}
      />
      <ul className={styles.said}>
        {held
          .filter(({ comment, reason }) => comment !== '' || reason !== '')
          .map(({ rater, comment, reason }) => (
            <li key={rater}>
              <strong>{rater}:</strong> {comment}
              {reason === '' ? null : (
                <span className={styles.muted}> {say('Supersedes an earlier rating: {reason}', { reason })}</span>
              )}
            </li>
          ))}
      </ul>
      {earlier.length === 0 ? null : (
        <details>
          <summary>{say('Superseded ratings')}</summary>
          <ul className={styles.said}>
            {earlier.map((one, i) => (
              <li key={i}>{line(one)}</li>
            ))}
          </ul>
        </details>
      )}
    </>
  );
}

type Stored = (all: { requests: RatingRequest[] }) => void;

function Request({
  trial,
  request,
  onChanged,
}: {
  readonly trial: string;
  readonly request: RatingRequest;
  readonly onChanged: Stored;
}) {
  const [rating, setRating] = useState(false);
  const rated = request.ratings.some(({ own }) => own);
  const withdrawn = useMutation({
    mutationFn: () => withdrawRatingRequest(trial, request.rubric.id),
    onSuccess: onChanged,
  });
  const { rubric, raters, submitted, complete, blind, may_rate } = request;
  return (
    <section className={styles.request} aria-label={rubric.title}>
      <div className={styles.head}>
        <h3>{rubric.title}</h3>
        <Badge tone={complete ? 'good' : 'neutral'}>
          {say('rated by {submitted} of {raters}', { submitted: formatCount(submitted), raters: formatCount(raters) })}
        </Badge>
        {blind && !complete ? <Badge tone="accent">{say('name hidden')}</Badge> : null}
      </div>
      {complete || !may_rate ? null : (
        <p className={styles.muted}>
          {blind
            ? say('Ratings of others and the trainee’s name are shown when all have rated.')
            : say('Ratings of others are shown when all have rated.')}
        </p>
      )}
      <Given request={request} />
      {may_rate && rating ? (
        <RatingForm
          trial={trial}
          request={request}
          onRated={(all) => {
            setRating(false);
            onChanged(all);
          }}
        />
      ) : null}
      <div className={styles.buttons}>
        {may_rate ? (
          <Button look={rated || rating ? 'plain' : 'solid'} onClick={() => setRating(!rating)}>
            {rating ? say('Close') : rated ? say('Supersede my rating…') : say('Rate this trial')}
          </Button>
        ) : null}
        {may_rate && submitted === 0 ? (
          <Button look="quiet" disabled={withdrawn.isPending} onClick={() => withdrawn.mutate()}>
            {say('Withdraw')}
          </Button>
        ) : null}
      </div>
      {withdrawn.isError ? (
        <Notice tone="bad" title={say('The request was not withdrawn.')}>
          {withdrawn.error.message}
        </Notice>
      ) : null}
    </section>
  );
}

/** Has the trial rated by a rubric by which it is not rated yet. */
function Asking({
  trial,
  requests,
  onChanged,
}: {
  readonly trial: string;
  readonly requests: readonly RatingRequest[];
  readonly onChanged: Stored;
}) {
  const all = useQuery(rubricsQuery).data?.rubrics ?? [];
  const free = [...new Map(all.map((one) => [one.id, one])).values()].filter(
    ({ id }) => !requests.some(({ rubric }) => rubric.id === id),
  );
  const [chosen, setChosen] = useState('');
  const [raters, setRaters] = useState('2');
  const [blind, setBlind] = useState(false);
  const rubric = free.find(({ id }) => id === chosen)?.id ?? free[0]?.id ?? '';
  const asked = useMutation({
    mutationFn: () => askForRating(trial, { rubric, blind, raters: Number(raters) }),
    onSuccess: onChanged,
  });
  if (free.length === 0)
    return all.length === 0 ? (
      <p className={styles.muted}>{say('There is no rubric yet; a programme director makes them.')}</p>
    ) : null;
  return (
    <div className={styles.asking}>
      <Select
        label={say('Rubric')}
        value={rubric}
        onChange={(event) => setChosen(event.target.value)}
        options={free.map(({ id, title }) => ({ value: id, text: title }))}
      />
      <Select
        label={say('Raters')}
        value={raters}
        onChange={(event) => setRaters(event.target.value)}
        options={['1', '2', '3', '4', '5'].map((value) => ({ value, text: value }))}
      />
      <label className={styles.check}>
        <input type="checkbox" checked={blind} onChange={(event) => setBlind(event.target.checked)} />{' '}
        {say('hide the trainee’s name until all have rated')}
      </label>
      <Button disabled={asked.isPending} onClick={() => asked.mutate()}>
        {say('Have this trial rated')}
      </Button>
      {asked.isError ? (
        <Notice tone="bad" title={say('The trial is not to be rated yet.')}>
          {asked.error.message}
        </Notice>
      ) : null}
    </div>
  );
}

/** Ratings of the trial by people. */
export function Ratings({ trial, may }: { readonly trial: string; readonly may: boolean }) {
  const query = useQuery(trialRatingsQuery(trial));
  const client = useQueryClient();
  const store: Stored = (all) => {
    client.setQueryData(trialRatingsQuery(trial).queryKey, all);
    // Names are shown once all have rated.
    for (const queryKey of [ratingRequestsQuery.queryKey, trialQuery(trial).queryKey, ['trials'], ['rating-agreement']])
      void client.invalidateQueries({ queryKey });
  };
  const requests = query.data?.requests;
  return (
    <Card title={say('Ratings')}>
      <div className={styles.stack}>
        {query.isError ? (
          <Notice tone="bad" title={say('The ratings could not be loaded.')} onRetry={() => void query.refetch()}>
            {query.error.message}
          </Notice>
        ) : null}
        {query.isPending ? <Skeleton height="120px" /> : null}
        {requests?.length === 0 ? <p className={styles.muted}>{say('No ratings yet.')}</p> : null}
        {requests?.map((request) => (
          <Request key={request.rubric.id} trial={trial} request={request} onChanged={store} />
        ))}
        {may && requests ? <Asking trial={trial} requests={requests} onChanged={store} /> : null}
      </div>
    </Card>
  );
}
