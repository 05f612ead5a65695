import { useMutation, useQuery, useQueryClient } from '@tanstack/react-query';
import { Link } from 'wouter';
import { publishScenario, scenariosQuery, type ScenarioVersion } from '@/api';
import { marked, say } from '@/language';
import { Badge, Button, Card, DataTable, Notice, Table, useTitle } from '@/ui';
import { formatDateTime } from '@/units';
import styles from './scenarios.module.css';
import { kindLabel } from './labels';

/** Scenarios of the probing rig: built-in ones and saved versions. */
export function ScenariosPage() {
  useTitle(say('Scenarios'));
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
      <Notice tone="bad" title={say('The scenarios could not be loaded.')} onRetry={() => void query.refetch()}>
        {query.error.message}
      </Notice>
    );
  return (
    <div className={styles.page}>
      <div>
        <h1>{say('Scenarios')}</h1>
        <p className={styles.lead}>
          {say(
            'Bone models of the probing rig: layers of bone, walls that are breached, and soft tissue behind them. Start from a built-in scenario or a saved version. Only published versions can be assigned.',
          )}
        </p>
      </div>
      <Card title={say('Built-in scenarios')}>
        <Table
          caption={say('Built-in scenarios')}
          rows={query.data?.tuned}
          keyOf={({ kind }) => kind}
          empty=""
          columns={[
            { name: marked('Scenario'), cell: ({ kind, name }) => <Link href={`/scenarios/${kind}`}>{name}</Link> },
            { name: marked('Kind'), cell: ({ kind }) => kindLabel(kind) },
          ]}
        />
      </Card>
      <Card title={say('Saved versions')}>
        <div className={styles.stack}>
          <DataTable<ScenarioVersion>
            address=""
            caption={say('Versions')}
            minWidth={640}
            rows={query.data?.scenarios}
            keyOf={({ id }) => id}
            empty={say('No saved versions yet.')}
            columns={[
              {
                name: marked('Scenario'),
                by: (one) => one.name,
                cell: (one) => <Link href={`/scenarios/${one.id}`}>{one.name}</Link>,
              },
              { name: marked('Kind'), by: ({ kind }) => kindLabel(kind), cell: ({ kind }) => kindLabel(kind) },
              {
                name: marked('Created'),
                by: (one) => one.made_utc_us,
                cell: (one) => say('{date} by {name}', { date: formatDateTime(one.made_utc_us), name: one.made_by }),
              },
              {
                name: marked('Based on'),
                cell: (one) => (one.parent === null ? '–' : (names.get(one.parent) ?? one.parent.slice(0, 12))),
              },
              {
                name: marked('State'),
                by: (one) => one.published,
                cell: (one) =>
                  one.published ? <Badge tone="good">{say('published')}</Badge> : <Badge>{say('not published')}</Badge>,
              },
              {
                name: <span className="hidden-visually">{say('Actions')}</span>,
                cell: (one) => (
                  <Button
                    look="quiet"
                    disabled={published.isPending}
                    label={`${one.published ? say('Unpublish') : say('Publish')}: ${one.name}`}
                    onClick={() => published.mutate({ one, to: !one.published })}
                  >
                    {one.published ? say('Unpublish') : say('Publish')}
                  </Button>
                ),
              },
            ]}
          />
          <p className={styles.message} role="status">
            {published.isSuccess ? (
              <>
                {published.variables.to
                  ? say('{name} is published and can be assigned.', { name: published.variables.one.name })
                  : say('{name} is unpublished; existing assignments continue.', {
                      name: published.variables.one.name,
                    })}{' '}
                <Button
                  look="quiet"
                  onClick={() => published.mutate({ one: published.variables.one, to: !published.variables.to })}
                >
                  {say('Undo')}
                </Button>
              </>
            ) : null}
            {published.isError ? say('The action failed: {why}', { why: published.error.message }) : null}
          </p>
        </div>
      </Card>
    </div>
  );
}
