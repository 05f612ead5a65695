import { useMutation, useQuery, useQueryClient } from '@tanstack/react-query';
import { useState } from 'react';
import { Link, useLocation } from 'wouter';
import { addRubric, rubricsQuery, sessionQuery, type Rubric } from '@/api';
import { say } from '@/language';
import { Button, Card, Field, Notice, Skeleton } from '@/ui';
import { formatCount, formatDateTime } from '@/units';
import { globalRating, idFrom, itemOf, itemProblem, newItem, type ItemDraft } from './draft';
import { Frame } from './frame';
import styles from './rating.module.css';

function ItemFields({
  draft,
  place,
  onChange,
  onRemove,
}: {
  readonly draft: ItemDraft;
  readonly place: number;
  readonly onChange: (to: Partial<ItemDraft>) => void;
  readonly onRemove: () => void;
}) {
  const field = (name: keyof Omit<ItemDraft, 'key'>, label: string, maxLength = 500) => (
    <Field
      label={label}
      value={draft[name]}
      maxLength={maxLength}
      {...(name === 'low' || name === 'high' ? { inputMode: 'numeric' as const } : {})}
      onChange={(event) => onChange({ [name]: event.target.value })}
    />
  );
  return (
    <fieldset className={styles.item}>
      <legend>{say('Item {number}', { number: formatCount(place) })}</legend>
      <div className={styles.names}>
        {field('label', say('Name'), 100)}
        {field('text', say('What is looked at (optional)'))}
        {field('low', say('Low end, points'), 2)}
        {field('high', say('High end, points'), 2)}
      </div>
      <div className={styles.anchors}>
        {field('low_text', say('Low end'))}
        {field('middle_text', say('Middle (optional)'))}
        {field('high_text', say('High end'))}
      </div>
      <div className={styles.under}>
        <span role="status" className={styles.muted}>
          {itemProblem(draft)}
        </span>
        <Button look="quiet" label={say('Remove item {number}', { number: formatCount(place) })} onClick={onRemove}>
          {say('Remove')}
        </Button>
      </div>
    </fieldset>
  );
}

/** Makes a rubric, or the next version of one. */
function Editing({ of }: { readonly of: Rubric | undefined }) {
  const client = useQueryClient();
  const [, go] = useLocation();
  const [title, setTitle] = useState(of?.title ?? '');
  const [reason, setReason] = useState('');
  const [items, setItems] = useState<readonly ItemDraft[]>((of?.items ?? []).map((one) => newItem(one)));
  const known = useQuery(rubricsQuery).data?.rubrics ?? [];
  const id = of?.id ?? idFrom(title);
  const made = useMutation({
    mutationFn: () => addRubric(id, title.trim(), items.map(itemOf), reason.trim()),
    onSuccess: (list) => {
      client.setQueryData(rubricsQuery.queryKey, list);
      go('/ratings/rubrics');
    },
  });
  const taken = !of && known.some((one) => one.id === id);
  const wrong =
    id === ''
      ? say('Give the rubric a title.')
      : taken
        ? say('A rubric has this title already.')
        : items.length === 0
          ? say('Add an item.')
          : items.some((one) => itemProblem(one) !== '')
            ? say('Complete every item.')
            : '';
  const change = (key: number, to: Partial<ItemDraft>) =>
    setItems(items.map((one) => (one.key === key ? { ...one, ...to } : one)));
  return (
    <Card title={of ? say('New version of {title}', { title: of.title }) : say('New rubric')}>
      <div className={styles.stack}>
        <div className={styles.names}>
          <Field
            label={say('Title')}
            value={title}
            maxLength={100}
            onChange={(event) => setTitle(event.target.value)}
          />
          {of ? (
            <Field
              label={say('Reason of the change (optional)')}
              value={reason}
              maxLength={400}
              onChange={(event) => setReason(event.target.value)}
            />
          ) : null}
        </div>
        {items.map((one, place) => (
          <ItemFields
            key={one.key}
            draft={one}
            place={place + 1}
            onChange={(to) => change(one.key, to)}
            onRemove={() => setItems(items.filter(({ key }) => key !== one.key))}
          />
        ))}
        <div className={styles.buttons}>
          <Button onClick={() => setItems([...items, newItem()])}>{say('Add an item')}</Button>
          {items.length === 0 ? (
            <Button onClick={() => setItems(globalRating().map((one) => newItem(one)))}>
              {say('Begin with the global rating scale of OSATS')}
            </Button>
          ) : null}
        </div>
        {made.isError ? (
          <Notice tone="bad" title={say('The rubric was not stored.')}>
            {made.error.message}
          </Notice>
        ) : null}
        <div className={styles.go}>
          <span>{wrong}</span>
          <Button look="solid" disabled={wrong !== '' || made.isPending} onClick={() => made.mutate()}>
            {of ? say('Store as a new version') : say('Store the rubric')}
          </Button>
        </div>
      </div>
    </Card>
  );
}

function Versions({ of }: { readonly of: readonly Rubric[] }) {
  return (
    <Card title={say('Versions')}>
      <ul className={styles.versions}>
        {of.toReversed().map(({ version, made_utc_us, made_by, reason, items }) => (
          <li key={version}>
            <details>
              <summary>
                {say('Version {version}, {date} by {name}', {
                  version: formatCount(version),
                  date: formatDateTime(made_utc_us),
                  name: made_by,
                })}
                {reason === '' ? '' : `: ${reason}`}
              </summary>
              <ol>
                {items.map(({ label, low, high, low_text, middle_text, high_text }) => (
                  <li key={label}>
                    <strong>{label}</strong>:{' '}
                    {say('{low} ({low_text}) to {high} ({high_text})', {
                      low: formatCount(low),
                      low_text,
                      high: formatCount(high),
                      high_text,
                    })}
                    {middle_text === '' ? '' : say(', middle: {text}', { text: middle_text })}
                  </li>
                ))}
              </ol>
            </details>
          </li>
        ))}
      </ul>
    </Card>
  );
}

export function RubricEditor({ id }: { readonly id?: string }) {
  const query = useQuery(rubricsQuery);
  const role = useQuery({ ...sessionQuery, enabled: false }).data?.role;
  const may = role === 'admin' || role === 'director';
  const versions = (query.data?.rubrics ?? []).filter((one) => one.id === id);
  const of = versions.at(-1);
  const ready = id === undefined || query.data !== undefined;
  return (
    <Frame
      at="/ratings/rubrics"
      lead={say(
        'Items with whole points; say in words what the lowest, the middle and the highest mean. Stored versions never change.',
      )}
    >
      <p>
        <Link href="/ratings/rubrics">← {say('Rubrics')}</Link>
      </p>
      {query.isError ? (
        <Notice tone="bad" title={say('The rubric could not be loaded.')} onRetry={() => void query.refetch()}>
          {query.error.message}
        </Notice>
      ) : ready ? null : (
        <Skeleton height="480px" />
      )}
      {query.data && id !== undefined && !of ? <Notice tone="warn" title={say('There is no such rubric.')} /> : null}
      {versions.length > 0 ? <Versions of={versions} /> : null}
      {may && ready && (id === undefined || of) ? <Editing of={of} /> : null}
    </Frame>
  );
}
