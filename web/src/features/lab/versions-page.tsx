import { useQuery } from '@tanstack/react-query';
import type { ReactNode } from 'react';
import { Link, useLocation, useSearch } from 'wouter';
import {
  measurementsQuery,
  modelAddress,
  modelFileQuery,
  modelsQuery,
  type MeasurementSet,
  type ModelVersion,
} from '@/api';
import { say } from '@/language';
import { Badge, Button, Card, Notice, Scroll, Select, Skeleton, useTitle } from '@/ui';
import { formatDateTime, formatFigure, isoDateTime, kNone } from '@/units';
import { Channels, Headline } from './comparison-parts';
import { Series } from './compare-step';
import { differences } from './differences';
import styles from './lab.module.css';
import { SendCard } from './send-card';
import { parameterName } from './parameters';
import { RunState } from './run-state';
import { useComparison } from './use-run';
import { setFacts } from './names';

interface Picked {
  readonly a: string | null;
  readonly b: string | null;
  readonly set: string | null;
}

function Node({
  model,
  all,
  picked,
  pick,
}: {
  readonly model: ModelVersion;
  readonly all: readonly ModelVersion[];
  readonly picked: Picked;
  readonly pick: (changes: Partial<Picked>) => void;
}) {
  const children = all.filter(({ parent }) => parent === model.id);
  return (
    <li>
      <div className={styles.version} data-chosen={model.id === picked.a || model.id === picked.b || undefined}>
        <span className={styles.choiceText}>
          <span className={styles.choiceName}>
            {model.name} {model.parent === null ? null : <Badge tone="accent">{say('derived')}</Badge>}
          </span>
          <span className={styles.muted}>{[say(model.rig), model.note].filter(Boolean).join(' · ')}</span>
        </span>
        <span className={styles.muted}>
          <time dateTime={isoDateTime(model.made_utc_us)}>{formatDateTime(model.made_utc_us)}</time>, {model.made_by}
        </span>
        <span className={styles.buttons}>
          <Button
            pressed={model.id === picked.a}
            label={say('Old: {model}, {time}', {
              model: model.name,
              time: formatDateTime(model.made_utc_us),
            })}
            onClick={() => pick({ a: model.id })}
          >
            {say('Old')}
          </Button>
          <Button
            pressed={model.id === picked.b}
            label={say('New: {model}, {time}', {
              model: model.name,
              time: formatDateTime(model.made_utc_us),
            })}
            onClick={() => pick({ b: model.id })}
          >
            {say('New')}
          </Button>
          <a
            href={modelAddress(model.id)}
            download={`${model.name}.model.json`}
            aria-label={say('Download {name}', { name: model.name })}
          >
            {say('Download')}
          </a>
        </span>
      </div>
      {children.length > 0 ? (
        <ul className={styles.tree}>
          {children.map((child) => (
            <Node key={child.id} model={child} all={all} picked={picked} pick={pick} />
          ))}
        </ul>
      ) : null}
    </li>
  );
}

function ParameterDifferences({ a, b }: { readonly a: ModelVersion; readonly b: ModelVersion }) {
  const old = useQuery(modelFileQuery(a.id)),
    now = useQuery(modelFileQuery(b.id));
  const failed = old.error ?? now.error;
  if (failed)
    return (
      <Notice tone="bad" title={say('The files could not be loaded.')}>
        {failed.message}
      </Notice>
    );
  if (!old.data || !now.data) return <Skeleton height="160px" />;
  const rows = differences(old.data, now.data);
  if (rows.length === 0) return <p>{say('All parameters are the same.')}</p>;
  return (
    <Scroll label={say('Parameters that differ')}>
      <table className={styles.table}>
        <caption className="hidden-visually">{say('Parameters that differ')}</caption>
        <thead>
          <tr>
            <th scope="col">{say('Parameter')}</th>
            <th scope="col" className={styles.number}>
              {say('Old')}
            </th>
            <th scope="col" className={styles.number}>
              {say('New')}
            </th>
          </tr>
        </thead>
        <tbody>
          {rows.map((row) => {
            const { name, unit } = parameterName(row.name);
            const cell = (value: number | null): ReactNode => (value === null ? kNone : formatFigure(value, unit, 5));
            return (
              <tr key={row.name}>
                <th scope="row">
                  {name}{' '}
                  {row.a === null ? (
                    <Badge tone="accent">{say('new')}</Badge>
                  ) : row.b === null ? (
                    <Badge tone="warn">{say('removed')}</Badge>
                  ) : null}
                </th>
                <td className={styles.number}>{cell(row.a)}</td>
                <td className={styles.number}>{cell(row.b)}</td>
              </tr>
            );
          })}
        </tbody>
      </table>
    </Scroll>
  );
}

function VersionComparison({
  a,
  b,
  set,
}: {
  readonly a: ModelVersion;
  readonly b: ModelVersion;
  readonly set: MeasurementSet;
}) {
  const { run, error, begin, retry } = useComparison(a.id, set.id, b.id);
  if (error)
    return (
      <Notice tone="bad" title={say('The comparison could not be made.')} onRetry={retry}>
        {error.message}
      </Notice>
    );
  if (!run) return <Skeleton height="480px" />;
  if (!run.comparisons) return <RunState run={run} what={say('The comparison')} again={begin} />;
  const names = { before: say('old'), after: say('new') };
  return (
    <div className={styles.stack}>
      <Headline {...run.comparisons} names={names} />
      <Series drawable={{ run, ...run.comparisons, names, rig: a.rig }} />
      <Channels {...run.comparisons} names={names} rig={a.rig} />
    </div>
  );
}

/** The tree of model versions, and the comparison of any two of them. */
export function VersionsPage() {
  useTitle(say('Model versions'));
  const search = new URLSearchParams(useSearch());
  const [, go] = useLocation();
  const models = useQuery(modelsQuery),
    sets = useQuery(measurementsQuery);
  const all = models.data?.models ?? [];
  const picked: Picked = { a: search.get('a'), b: search.get('b'), set: search.get('set') };
  const pick = (changes: Partial<Picked>) => {
    const next = { ...picked, ...changes };
    go(
      `/lab/versions?${new URLSearchParams(Object.entries(next).flatMap(([key, value]) => (value === null ? [] : [[key, value]])))}`,
      { replace: true },
    );
  };
  const a = all.find(({ id }) => id === picked.a),
    b = all.find(({ id }) => id === picked.b);
  const fitting = (sets.data?.measurements ?? []).filter(({ rig }) => rig === null || a === undefined || rig === a.rig);
  const set = fitting.find(({ id }) => id === picked.set) ?? fitting[0];
  const known = new Set(all.map(({ id }) => id));
  const roots = all.filter(({ parent }) => parent === null || !known.has(parent));
  return (
    <div className={styles.page}>
      <p className={styles.back}>
        <Link href="/lab">{say('← Model lab')}</Link>
      </p>
      <div>
        <h1>{say('Model versions')}</h1>
        <p className={styles.lead}>
          {say(
            'Versions cannot be changed. Each version is listed below the version that it is based on. Choose an old and a new version to compare them.',
          )}
        </p>
      </div>
      {models.isError ? (
        <Notice tone="bad" title={say('The versions could not be loaded.')} onRetry={() => void models.refetch()}>
          {models.error.message}
        </Notice>
      ) : null}
      <Card title={say('History')}>
        {models.isPending ? (
          <Skeleton height="160px" />
        ) : roots.length === 0 ? (
          <p className={styles.muted}>
            {say('No models yet.')} <Link href="/lab">{say('Add the first one in the lab.')}</Link>
          </p>
        ) : (
          <ul className={styles.tree} data-part="tree">
            {roots.map((root) => (
              <Node key={root.id} model={root} all={all} picked={picked} pick={pick} />
            ))}
          </ul>
        )}
      </Card>
      {b ? <SendCard key={b.id} version={b} /> : null}
      {a && b && a.id !== b.id ? (
        a.rig === b.rig ? (
          <>
            <Card title={say('Parameters that differ')}>
              <ParameterDifferences a={a} b={b} />
            </Card>
            {set ? (
              <Card
                title={say('Comparison with measurements')}
                aside={
                  <Select
                    label={<span className="hidden-visually">{say('Measurements')}</span>}
                    value={set.id}
                    onChange={(event) => pick({ set: event.target.value })}
                    options={fitting.map((one) => ({ value: one.id, text: `${one.name} (${setFacts(one)})` }))}
                  />
                }
              >
                <VersionComparison key={`${a.id} ${b.id} ${set.id}`} a={a} b={b} set={set} />
              </Card>
            ) : null}
          </>
        ) : (
          <Notice tone="warn" title={say('These versions belong to different rigs.')}>
            {say('They cannot be compared with the same measurements.')}
          </Notice>
        )
      ) : null}
    </div>
  );
}
