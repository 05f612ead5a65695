import { useMutation } from '@tanstack/react-query';
import { useId, useState, type FormEvent } from 'react';
import { addRating, type RatingRequest, type RubricItem } from '@/api';
import { say } from '@/language';
import { Button, Field, Notice } from '@/ui';
import { formatCount } from '@/units';
import styles from './rating.module.css';

function ItemScale({
  item,
  points,
  onPoints,
}: {
  readonly item: RubricItem;
  readonly points: number | null;
  readonly onPoints: (points: number) => void;
}) {
  const id = useId();
  const scale = Array.from({ length: item.high - item.low + 1 }, (_, i) => item.low + i);
  return (
    <fieldset className={styles.item}>
      <legend>{item.label}</legend>
      {item.text === '' ? null : <p className={styles.muted}>{item.text}</p>}
      <div className={styles.points}>
        {scale.map((one) => (
          <label key={one}>
            <input type="radio" name={id} checked={points === one} onChange={() => onPoints(one)} />
            {formatCount(one)}
          </label>
        ))}
      </div>
      <ul className={styles.anchors}>
        <li>
          {formatCount(item.low)}: {item.low_text}
        </li>
        {item.middle_text === '' ? null : <li>{say('middle: {middle_text}', { middle_text: item.middle_text })}</li>}
        <li>
          {formatCount(item.high)}: {item.high_text}
        </li>
      </ul>
    </fieldset>
  );
}

/** Rates a trial, or supersedes the own rating. */
export function RatingForm({
  trial,
  request,
  onRated,
}: {
  readonly trial: string;
  readonly request: RatingRequest;
  readonly onRated: (all: { requests: RatingRequest[] }) => void;
}) {
  const { rubric } = request;
  const before = request.ratings.find(({ own, holds }) => own && holds);
  const [points, setPoints] = useState<readonly (number | null)[]>(
    before?.scores ?? Array.from({ length: rubric.items.length }, () => null),
  );
  const [comment, setComment] = useState(before?.comment ?? '');
  const [reason, setReason] = useState('');
  const given = points.filter((one): one is number => one !== null);
  const sent = useMutation({
    mutationFn: () =>
      addRating(trial, { rubric: rubric.id, scores: given, comment: comment.trim(), reason: reason.trim() }),
    onSuccess: onRated,
  });
  const complete = given.length === rubric.items.length && (!before || reason.trim() !== '');
  const submit = (event: FormEvent) => {
    event.preventDefault();
    sent.mutate();
  };
  return (
    <form className={styles.form} onSubmit={submit} aria-label={say('Rate by {title}', { title: rubric.title })}>
      <div className={styles.items}>
        {rubric.items.map((item, i) => (
          <ItemScale
            key={i}
            item={item}
            points={points[i] ?? null}
            onPoints={(to) => setPoints(points.map((one, at) => (at === i ? to : one)))}
          />
        ))}
      </div>
      <Field
        label={say('Comment (optional)')}
        value={comment}
        maxLength={1000}
        onChange={(event) => setComment(event.target.value)}
      />
      {before ? (
        <Field
          label={say('Reason to supersede your rating')}
          value={reason}
          maxLength={400}
          onChange={(event) => setReason(event.target.value)}
        />
      ) : null}
      {sent.isError ? (
        <Notice tone="bad" title={say('The rating was not stored.')}>
          {sent.error.message}
        </Notice>
      ) : null}
      <div className={styles.go}>
        <span className={styles.muted}>
          {say('{given} of {all} items.', {
            given: formatCount(given.length),
            all: formatCount(rubric.items.length),
          })}{' '}
          {before ? say('The rating before is kept.') : say('A submitted rating cannot be changed, only superseded.')}
        </span>
        <Button look="solid" type="submit" disabled={!complete || sent.isPending}>
          {sent.isPending ? say('Saving…') : before ? say('Supersede my rating') : say('Submit rating')}
        </Button>
      </div>
    </form>
  );
}
