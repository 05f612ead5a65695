import { useMutation, useQuery, useQueryClient } from '@tanstack/react-query';
import { Link } from 'wouter';
import { publishScenario, scenariosQuery, type ScenarioVersion } from '@/api';
import { Badge, Button, Card, Notice, Table, useTitle } from '@/ui';
import { formatDateTime } from '@/units';
import styles from './scenarios.module.css';
import { kKindWords } from './words';

/** Scenarios of the probing rig: those that ship, and the versions that people tuned from them. */
export function ScenariosPage() {
  useTitle('Scenarios');
  const client = useQueryClient();
  const query = useQuery(scenariosQuery);
  const published = useMutation({
    mutationFn: ({ one, to }: { one: ScenarioVersion; to: boolean }) => publishScenario(one.id, to),
    onSuccess: () => client.invalidateQueries({ queryKey: scenariosQuery.queryKey, exact: true }),
  });
  const names = new Map([...(query.data?.scenarios ?? []), ...(query.data?.tuned ?? [])].map(({ id, name }) => [id, name]));
  if (query.isError) return <Notice tone="bad" title="The scenarios could not be loaded." onRetry={() => void query.refetch()}>{query.error.message}</Notice>;
  return (
    <div className={styles.page}>
      <div><h1>Scenarios</h1><p className={styles.lead}>What the probing rig plays: bone in layers, walls that give way, soft tissue behind them. Start from one that ships or from a version of yours; each version can be offered for assignments by itself.</p></div>
      <Card title="Start from">
        <Table caption="Scenarios that ship" rows={query.data?.tuned} keyOf={({ kind }) => kind} empty="" columns={[
          { name: 'Scenario', cell: ({ kind, name }) => <Link href={`/scenarios/${kind}`}>{name}</Link> },
          { name: 'Kind', cell: ({ kind }) => kKindWords[kind] },
        ]} />
      </Card>
      <Card title="Versions">
        <div className={styles.stack}>
          <Table<ScenarioVersion> caption="Versions" minWidth={640} rows={query.data?.scenarios} keyOf={({ id }) => id} empty="Nobody has tuned one yet." columns={[
            { name: 'Scenario', cell: (one) => <Link href={`/scenarios/${one.id}`}>{one.name}</Link> },
            { name: 'Kind', cell: ({ kind }) => kKindWords[kind] },
            { name: 'Made', cell: (one) => `${formatDateTime(one.made_utc_us)} by ${one.made_by}` },
            { name: 'From', cell: (one) => (one.parent === null ? '–' : names.get(one.parent) ?? one.parent.slice(0, 12)) },
            { name: 'State', cell: (one) => (one.published ? <Badge tone="good">offered</Badge> : <Badge>kept</Badge>) },
            { name: <span className="hidden-visually">Decide</span>, cell: (one) => <Button look="quiet" disabled={published.isPending} label={`${one.published ? 'Offer no more' : 'Offer'}: ${one.name}`} onClick={() => published.mutate({ one, to: !one.published })}>{one.published ? 'Offer no more' : 'Offer'}</Button> },
          ]} />
          <p className={styles.said} role="status">
            {published.isSuccess ? <>{published.variables.one.name} is {published.variables.to ? 'offered for assignments.' : 'offered no more; what was assigned of it goes on.'} <Button look="quiet" onClick={() => published.mutate({ one: published.variables.one, to: !published.variables.to })}>Undo</Button></> : null}
            {published.isError ? `That was not done: ${published.error.message}` : null}
          </p>
        </div>
      </Card>
    </div>
  );
}
