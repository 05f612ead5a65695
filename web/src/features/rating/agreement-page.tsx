import { useQuery } from '@tanstack/react-query';
import { useState } from 'react';
import { agreementQuery, rubricsQuery, type Agreement, type RaterGroup } from '@/api';
import { Badge, Card, Notice, Select, Skeleton, Table } from '@/ui';
import { formatCount, formatFigure, kNone } from '@/units';
import { DifferenceChart } from './difference-chart';
import { Frame } from './frame';
import styles from './rating.module.css';

const listed = (raters: readonly string[]) => raters.join(' and ');

/** "0.62 (0.07 to 0.93)". */
function within(value: number | null, low: number | null, high: number | null): string {
  if (value === null) return kNone;
  const ends = low === null || high === null ? '' : ` (${formatFigure(low, '', 2)} to ${formatFigure(high, '', 2)})`;
  return formatFigure(value, '', 2) + ends;
}

interface Row extends Agreement {
  readonly label: string;
}

function Group({ of }: { readonly of: RaterGroup }) {
  const rows: Row[] = [{ ...of.total, label: 'Sum of all items' }, ...of.items];
  const [first = '', second = ''] = of.raters;
  return (
    <Card
      title={listed(of.raters)}
      aside={of.simulated ? <Badge tone="warn">simulated trials among them</Badge> : undefined}
    >
      <div className={styles.stack}>
        <p>{formatCount(of.trials)} trials rated by each, without seeing another’s rating.</p>
        <Table<Row>
          caption={`Agreement of ${listed(of.raters)}`}
          minWidth={640}
          rows={rows}
          keyOf={({ label }, i) => `${i} ${label}`}
          empty=""
          columns={[
            { name: 'Item', cell: ({ label }) => label },
            {
              name: 'ICC(2,1), one rater',
              cell: (one) => within(one.single, one.single_low, one.single_high),
            },
            {
              name: `ICC(2,${formatCount(of.raters.length)}), mean of raters`,
              cell: (one) => within(one.mean, one.mean_low, one.mean_high),
            },
            { name: 'Weighted kappa', cell: ({ kappa }) => (kappa === null ? kNone : formatFigure(kappa, '', 2)) },
            { name: 'Remark', cell: ({ note }) => note },
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
      lead="Agreement of people who rated the same trials: two-way random intraclass correlations for absolute agreement (Shrout and Fleiss 1979) with 95 % intervals, and Cohen’s kappa weighted by the squares of the differences. Includes the trials that you may see and that all their raters have rated."
    >
      {failed ? (
        <Notice
          tone="bad"
          title="The agreement could not be loaded."
          onRetry={() => void (rubrics.isError ? rubrics : query).refetch()}
        >
          {failed.message}
        </Notice>
      ) : null}
      {all.length > 0 ? (
        <div className={styles.choose}>
          <Select
            label="Rubric"
            value={of ? `${of.id} ${of.version}` : ''}
            onChange={(event) => setChosen(event.target.value)}
            options={all.map(({ id, version, title }) => ({
              value: `${id} ${version}`,
              text: `${title}, version ${formatCount(version)}`,
            }))}
          />
        </div>
      ) : null}
      {rubrics.data && all.length === 0 ? <p>No rubrics yet.</p> : null}
      {query.data?.groups.length === 0 ? (
        <p>No trial has been rated by two or more people with this rubric yet.</p>
      ) : (
        query.data?.groups.map((group) => <Group key={group.raters.join(' ')} of={group} />)
      )}
      {failed || query.data || rubrics.data?.rubrics.length === 0 ? null : <Skeleton height="480px" />}
    </Frame>
  );
}
