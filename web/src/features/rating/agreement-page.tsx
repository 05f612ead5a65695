import { useQuery } from '@tanstack/react-query';
import { useState } from 'react';
import { agreementQuery, rubricsQuery, type Agreement, type RaterGroup } from '@/api';
import { marked, say } from '@/language';
import { Badge, Card, Notice, Select, Skeleton, Table } from '@/ui';
import { formatCount, formatFigure, kNone } from '@/units';
import { DifferenceChart } from './difference-chart';
import { Frame } from './frame';
import styles from './rating.module.css';

const listed = (raters: readonly string[]) => raters.join(` ${say('and')} `);

/** "0.62 (0.07 to 0.93)". */
function within(value: number | null, low: number | null, high: number | null): string {
  if (value === null) return kNone;
  const shown = formatFigure(value, '', 2);
  return low === null || high === null
    ? shown
    : say('{value} ({low} to {high})', {
        value: shown,
        low: formatFigure(low, '', 2),
        high: formatFigure(high, '', 2),
      });
}

interface Row extends Agreement {
  readonly label: string;
}

function Group({ of }: { readonly of: RaterGroup }) {
  const rows: Row[] = [{ ...of.total, label: say('Sum of all items') }, ...of.items];
  const [first = '', second = ''] = of.raters;
  return (
    <Card
      title={listed(of.raters)}
      aside={of.simulated ? <Badge tone="warn">{say('simulated trials among them')}</Badge> : undefined}
    >
      <div className={styles.stack}>
        <p>
          {say('{trials} trials rated by each, without seeing another’s rating.', { trials: formatCount(of.trials) })}
        </p>
        <Table<Row>
          caption={say('Agreement of {raters}', { raters: listed(of.raters) })}
          minWidth={640}
          rows={rows}
          keyOf={({ label }, i) => `${i} ${label}`}
          empty=""
          columns={[
            { name: marked('Item'), cell: ({ label }) => label },
            {
              name: marked('ICC(2,1), one rater'),
              cell: (one) => within(one.single, one.single_low, one.single_high),
            },
            {
              name: say('ICC(2,{count}), mean of raters', { count: formatCount(of.raters.length) }),
              cell: (one) => within(one.mean, one.mean_low, one.mean_high),
            },
            {
              name: marked('Weighted kappa'),
              cell: ({ kappa }) => (kappa === null ? kNone : formatFigure(kappa, '', 2)),
            },
            { name: marked('Remark'), cell: ({ note }) => note },
          ]}
        />
        {of.differences ? (
          <DifferenceChart first={first} second={second} totals={of.totals} differences={of.differences} />
        ) : null}
      </div>
    </Card>
  );
}

/** How far those who rated the same trials agree. */
export function AgreementPage() {
  const rubrics = useQuery(rubricsQuery);
  const all = rubrics.data?.rubrics ?? [];
  const [chosen, setChosen] = useState('');
  const of = all.find(({ id, version }) => `${id} ${version}` === chosen) ?? all.at(-1);
  const query = useQuery(agreementQuery(of?.id ?? '', of?.version ?? 1));
  const failed = rubrics.error ?? query.error;
  return (
    <Frame
      at="/ratings/agreement"
      lead={say(
        'Agreement of people who rated the same trials: two-way random intraclass correlations for absolute agreement (Shrout and Fleiss 1979) with 95 % intervals, and Cohen’s kappa weighted by the squares of the differences. Includes the trials that you may see and that all their raters have rated.',
      )}
    >
      {failed ? (
        <Notice
          tone="bad"
          title={say('The agreement could not be loaded.')}
          onRetry={() => void (rubrics.isError ? rubrics : query).refetch()}
        >
          {failed.message}
        </Notice>
      ) : null}
      {all.length > 0 ? (
        <div className={styles.choose}>
          <Select
            label={say('Rubric')}
            value={of ? `${of.id} ${of.version}` : ''}
            onChange={(event) => setChosen(event.target.value)}
            options={all.map(({ id, version, title }) => ({
              value: `${id} ${version}`,
              text: say('{title}, version {version}', { title, version: formatCount(version) }),
            }))}
          />
        </div>
      ) : null}
      {rubrics.data && all.length === 0 ? <p>{say('No rubrics yet.')}</p> : null}
      {query.data?.groups.length === 0 ? (
        <p>{say('No trial has been rated by two or more people with this rubric yet.')}</p>
      ) : (
        query.data?.groups.map((group) => <Group key={group.raters.join(' ')} of={group} />)
      )}
      {failed || query.data || rubrics.data?.rubrics.length === 0 ? null : <Skeleton height="480px" />}
    </Frame>
  );
}
