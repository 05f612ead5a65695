import { useMutation, useQuery, useQueryClient } from '@tanstack/react-query';
import { Link } from 'wouter';
import { publishScenario, scenariosQuery, type ScenarioVersion } from '@/api';
import { Badge, Button, Card, DataTable, Notice, Table, useTitle } from '@/ui';
import { formatDateTime } from '@/units';
import styles from './scenarios.module.css';
import { kKindLabels } from './labels';

/** Scenarios of the probing rig: built-in ones and saved versions. */
export function ScenariosPage() {
  useTitle('Scenarios');
  const client = useQueryClient();
  const query = useQuery(scenariosQuery);
  const published = useMutation({
    mutationFn: ({ one, to }: { one: ScenarioVersion; to: boolean }) => publishScenario(one.id, to),
    onSuccess: () => client.invalidateQueries({ queryKey: scenariosQuery.queryKey, exact: true }),
  });
  const names = new Map(
    [...(query.data?.scenarios ?? []), ...(query.data?.tuned ?? [])].map(({ id, name }) => [id, name]),
  );
  if (query.isError)
    return (
      <Notice tone="bad" title="The scenarios could not be loaded." onRetry={() => void query.refetch()}>
        {query.error.message}
      </Notice>
    );
  return (
    <div className={styles.page}>
      <div>
        <h1>Scenarios</h1>
        <p className={styles.lead}>
          Bone models of the probing rig: layers of bone, walls that are breached, and soft tissue behind them. Start
          from a built-in scenario or a saved version. Only published versions can be assigned.
        </p>
      </div>
      <Card title="Built-in scenarios">
        <Table
          caption="Built-in scenarios"
          rows={query.data?.tuned}
          keyOf={({ kind }) => kind}
          empty=""
          columns={[
            { name: 'Scenario', cell: ({ kind, name }) => <Link href={`/scenarios/${kind}`}>{name}</Link> },
            { name: 'Kind', cell: ({ kind }) => kKindLabels[kind] },
          ]}
        />
      </Card>
      <Card title="Saved versions">
        <div className={styles.stack}>
          <DataTable<ScenarioVersion>
            address=""
            caption="Versions"
            minWidth={640}
            rows={query.data?.scenarios}
            keyOf={({ id }) => id}
            empty="No saved versions yet."
            columns={[
              {
                name: 'Scenario',
                by: (one) => one.name,
                cell: (one) => <Link href={`/scenarios/${one.id}`}>{one.name}</Link>,
              },
              { name: 'Kind', by: ({ kind }) => kKindLabels[kind], cell: ({ kind }) => kKindLabels[kind] },
              {
                name: 'Created',
                by: (one) => one.made_utc_us,
                cell: (one) => `${formatDateTime(one.made_utc_us)} by ${one.made_by}`,
              },
              {
                name: 'Based on',
                cell: (one) => (one.parent === null ? '–' : (names.get(one.parent) ?? one.parent.slice(0, 12))),
              },
              {
                name: 'State',
                by: (one) => one.published,
                cell: (one) => (one.published ? <Badge tone="good">published</Badge> : <Badge>not published</Badge>),
              },
              {
                name: <span className="hidden-visually">Actions</span>,
                cell: (one) => (
                  <Button
                    look="quiet"
                    disabled={published.isPending}
                    label={`${one.published ? 'Unpublish' : 'Publish'}: ${one.name}`}
                    onClick={() => published.mutate({ one, to: !one.published })}
                  >
                    {one.published ? 'Unpublish' : 'Publish'}
                  </Button>
                ),
              },
            ]}
          />
          <p className={styles.message} role="status">
            {published.isSuccess ? (
              <>
                {published.variables.one.name} is{' '}
                {published.variables.to
                  ? 'published and can be assigned.'
                  : 'unpublished; existing assignments continue.'}{' '}
                <Button
                  look="quiet"
                  onClick={() => published.mutate({ one: published.variables.one, to: !published.variables.to })}
                >
                  Undo
                </Button>
              </>
            ) : null}
            {published.isError ? `The action failed: ${published.error.message}` : null}
          </p>
        </div>
      </Card>
    </div>
  );
}
