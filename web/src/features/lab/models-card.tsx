import { useMutation, useQuery, useQueryClient } from '@tanstack/react-query';
import { useRef, type ChangeEvent } from 'react';
import { Link } from 'wouter';
import { addModel, modelsQuery, type ModelVersion, type Rig } from '@/api';
import { say } from '@/language';
import { Badge, Button, Card, Notice } from '@/ui';
import { formatDateTime, isoDateTime } from '@/units';
import styles from './lab.module.css';

interface Props {
  /** Only versions for this rig can be compared with the chosen measurements. */
  readonly rig: Rig | null;
  readonly chosen: string | null;
  readonly choose: (id: string) => void;
}

const kMost_bytes = 1 << 20;

async function send(file: File): Promise<ModelVersion> {
  if (file.size > kMost_bytes)
    throw new Error(say('{name}: too large for a model file (limit: 1 MiB).', { name: file.name }));
  const text = await file.text();
  try {
    JSON.parse(text);
  } catch (reason) {
    throw new Error(
      say('{name}: not valid JSON: {message}', {
        name: file.name,
        message: reason instanceof Error ? reason.message : '',
      }),
    );
  }
  return addModel(text);
}

function ModelRow({
  model,
  chosen,
  choose,
}: {
  readonly model: ModelVersion;
  readonly chosen: boolean;
  readonly choose: () => void;
}) {
  return (
    <label className={styles.choice}>
      <input type="radio" name="model" checked={chosen} onChange={choose} />
      <span className={styles.choiceText}>
        <span className={styles.choiceName}>
          {model.name} {model.parent === null ? null : <Badge tone="accent">{say('derived')}</Badge>}
        </span>
        <span className={styles.muted}>{[say(model.rig), model.note].filter(Boolean).join(' · ')}</span>
      </span>
      <span className={styles.muted}>
        <time dateTime={isoDateTime(model.made_utc_us)}>{formatDateTime(model.made_utc_us)}</time>, {model.made_by}
      </span>
    </label>
  );
}

export function ModelsCard({ rig, chosen, choose }: Props) {
  const client = useQueryClient();
  const input = useRef<HTMLInputElement>(null);
  const query = useQuery(modelsQuery);
  const sent = useMutation({
    mutationFn: send,
    onSuccess: async (model) => {
      await client.invalidateQueries({ queryKey: modelsQuery.queryKey });
      choose(model.id);
    },
  });
  const upload = (event: ChangeEvent<HTMLInputElement>) => {
    const [file] = event.currentTarget.files ?? [];
    event.currentTarget.value = '';
    if (file) sent.mutate(file);
  };
  const models = query.data?.models.filter((model) => rig === null || model.rig === rig);
  const hidden = (query.data?.models.length ?? 0) - (models?.length ?? 0);
  return (
    <Card
      title={say('2 · Model')}
      aside={
        <span className={styles.buttons}>
          <Link href="/lab/versions">{say('All versions')}</Link>
          <Button onClick={() => input.current?.click()} disabled={sent.isPending}>
            {sent.isPending ? say('Sending…') : say('Add model file')}
          </Button>
        </span>
      }
    >
      <input
        ref={input}
        type="file"
        hidden
        accept=".json,application/json"
        aria-label={say('A model file')}
        data-part="model-file"
        onChange={upload}
      />
      <div className={styles.stack}>
        {sent.isError ? (
          <Notice tone="bad" title={say('The model was not added.')}>
            {sent.error.message}
          </Notice>
        ) : null}
        {query.isError ? (
          <Notice tone="bad" title={say('The list could not be loaded.')} onRetry={() => void query.refetch()}>
            {query.error.message}
          </Notice>
        ) : null}
        <fieldset className={styles.choices}>
          <legend className="hidden-visually">{say('Versions of models, newest first')}</legend>
          {models?.map((model) => (
            <ModelRow key={model.id} model={model} chosen={model.id === chosen} choose={() => choose(model.id)} />
          ))}
          {models?.length === 0 ? (
            <p className={styles.muted}>
              {rig === null
                ? say('No models yet.')
                : rig === 'probing'
                  ? say('No models of the probing rig yet.')
                  : say('No models of the palpation rig yet.')}{' '}
              {say('Add a model file (tractus-model/1).')}
            </p>
          ) : null}
        </fieldset>
        {hidden > 0 ? <p className={styles.muted}>{say('Models of the other rig are not listed.')}</p> : null}
      </div>
    </Card>
  );
}
