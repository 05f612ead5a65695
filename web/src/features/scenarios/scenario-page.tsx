import { useMutation, useQuery, useQueryClient } from '@tanstack/react-query';
import { useReducer, useState, type FormEvent } from 'react';
import { Link, useLocation } from 'wouter';
import {
  addScenario,
  ApiError,
  kKinds,
  scenarioCheckQuery,
  scenarioFileQuery,
  scenariosQuery,
  type ScenarioFile,
} from '@/api';
import { say } from '@/language';
import { Button, Card, Field, Notice, Select, Skeleton, useTitle, useSettled } from '@/ui';
import { draftOf, inMillimetres, kBone, kBreach } from './draft';
import { Knobs, Layers, Walls } from './fields';
import { Resistance } from './resistance';
import styles from './scenarios.module.css';
import { kindLabel } from './labels';

interface History {
  readonly file: ScenarioFile;
  readonly past: readonly ScenarioFile[];
}
const kMost = 100;

function step({ file, past }: History, next: ScenarioFile | 'undo'): History {
  if (next !== 'undo') return { file: next, past: [...past, file].slice(-kMost) };
  const before = past.at(-1);
  return before ? { file: before, past: past.slice(0, -1) } : { file, past };
}

function SaveForm({
  file,
  parent,
  ready,
}: {
  readonly file: ScenarioFile;
  readonly parent: string;
  readonly ready: boolean;
}) {
  const client = useQueryClient();
  const [, go] = useLocation();
  const saved = useMutation({
    mutationFn: (publish: boolean) => addScenario(draftOf(file), parent, publish),
    onSuccess: async () => {
      await client.invalidateQueries({ queryKey: scenariosQuery.queryKey, exact: true });
      go('/scenarios');
    },
  });
  const submit = (event: FormEvent) => {
    event.preventDefault();
    saved.mutate(true);
  };
  return (
    <form className={styles.keep} onSubmit={submit}>
      {saved.isError ? (
        <Notice tone="bad" title={say('The version was not saved.')}>
          {saved.error.message}
        </Notice>
      ) : null}
      <p className={styles.means}>
        {say(
          'Saved versions cannot be changed, so that earlier trials stay comparable. Your changes are saved as a new version under your name.',
        )}
      </p>
      <div className={styles.buttons}>
        <Button onClick={() => saved.mutate(false)} disabled={!ready || saved.isPending}>
          {say('Save')}
        </Button>
        <Button look="solid" type="submit" disabled={!ready || saved.isPending}>
          {say('Save and publish')}
        </Button>
      </div>
    </form>
  );
}

function Bench({ start, parent }: { readonly start: ScenarioFile; readonly parent: string }) {
  const [{ file, past }, go] = useReducer(step, { file: start, past: [] });
  const settled = useSettled(file, 200);
  const check = useQuery(scenarioCheckQuery(draftOf(settled)));
  const found = check.data;
  // A value that is refused has no curve: the last one stays, marked as such.
  const [curve, setCurve] = useState(found?.curve ?? null);
  if (found?.curve && found.curve !== curve) setCurve(found.curve);
  const late = check.isPlaceholderData || settled !== file;
  const unplaced =
    found && !found.ok && !/^\/(bone|breach|density|travel_m|walls_m|layers|name)/.test(found.field) ? found.error : '';
  const props = { file, check: found, onFile: go };
  return (
    <div className={styles.bench}>
      <div className={styles.stack}>
        <Card
          title={say('Resistance over depth')}
          aside={
            <Button onClick={() => go('undo')} disabled={past.length === 0}>
              {say('Undo')}
            </Button>
          }
        >
          <div className={styles.stack}>
            {check.isError ? (
              <Notice tone="bad" title={say('The scenario could not be checked.')} onRetry={() => void check.refetch()}>
                {check.error.message}
              </Notice>
            ) : null}
            {curve ? (
              <>
                <Resistance found={curve} late={late || !found?.curve} />
                {found && !found.curve ? (
                  <p className={styles.warn} role="status">
                    {say('The curve shows the last valid values. Correct the marked value.')}
                  </p>
                ) : null}
              </>
            ) : (
              <div className={styles.blank}>
                {found ? <p>{say('Correct the marked value to see the curve.')}</p> : <Skeleton height="340px" />}
              </div>
            )}
            <div className={styles.says} role="status">
              {found?.excessive.map((sentence) => (
                <p key={sentence} className={styles.warn}>
                  {inMillimetres(sentence)}
                </p>
              ))}
              {unplaced === '' ? null : <p className={styles.wrong}>{inMillimetres(unplaced)}</p>}
              {found?.ok && found.excessive.length === 0 ? (
                <p className={styles.means}>{say('Forces are within the limits of surgeon and actuator.')}</p>
              ) : null}
            </div>
          </div>
        </Card>
        <Card title={say('Save')}>
          <div className={styles.stack}>
            <div className={styles.knobs}>
              <Field
                label={say('Name (not shown to trainees)')}
                value={file.name}
                required
                maxLength={200}
                onChange={(event) => go({ ...file, name: event.target.value })}
              />
              <Select
                label={say('Kind')}
                value={file.kind}
                options={kKinds.map((kind) => ({ value: kind, text: kindLabel(kind) }))}
                onChange={(event) => {
                  const to = kKinds.find((kind) => kind === event.target.value);
                  if (to) go({ ...file, kind: to });
                }}
              />
            </div>
            <SaveForm file={file} parent={parent} ready={found?.ok === true && !late && file.name.trim() !== ''} />
          </div>
        </Card>
      </div>
      <div className={styles.stack}>
        <Card title={say('Bone')}>
          <Knobs knobs={kBone} {...props} />
        </Card>
        <Card title={say('Walls')}>
          <div className={styles.stack}>
            <Walls {...props} />
            {file.walls_m.length > 0 ? <Knobs knobs={kBreach} {...props} /> : null}
          </div>
        </Card>
        <Card title={say('Regions of different density')}>
          <Layers {...props} />
        </Card>
      </div>
    </div>
  );
}

/** Edits a copy of a scenario of the probing rig and shows its resistance. */
export function ScenarioPage({ id }: { readonly id: string }) {
  const query = useQuery(scenarioFileQuery(id));
  const missing = query.error instanceof ApiError && query.error.code === 'not_found';
  useTitle(query.data ? say('Scenario {name}', { name: query.data.name }) : say('Scenario'));
  return (
    <div className={styles.page}>
      <p>
        <Link href="/scenarios">← {say('Scenarios')}</Link>
      </p>
      {query.isError ? (
        <Notice
          tone={missing ? 'warn' : 'bad'}
          title={missing ? say('Scenario not found.') : say('The scenario could not be loaded.')}
          onRetry={missing ? undefined : () => void query.refetch()}
        >
          {query.error.message}
        </Notice>
      ) : null}
      {query.isPending ? (
        <div role="status">
          <span className="hidden-visually">{say('Loading the scenario')}</span>
          <Skeleton height="640px" />
        </div>
      ) : null}
      {query.data ? (
        <>
          <h1>{say('New version of {title}', { title: query.data.name })}</h1>
          <Bench start={query.data} parent={id} />
        </>
      ) : null}
    </div>
  );
}
