import type { Metric, TrialState } from '@/api';
import { say } from '@/language';
import { Card, Skeleton, Term } from '@/ui';
import { kNone, measureDigits, shownUnit } from '@/units';
import { type Arranged, arranged, shown } from './measure-rows';
import styles from './measures.module.css';

function Definition({ metric }: { readonly metric: Metric }) {
  return (
    <>
      {metric.definition} <span className={styles.source}>{say('Source: {source}.', { source: metric.source })}</span>
      {metric.note === '' ? null : (
        <>
          {' '}
          <em>{say(metric.note)}</em>
        </>
      )}
    </>
  );
}

function Cell({ metric }: { readonly metric: Metric | undefined }) {
  if (!metric) return <td className={styles.number}>{kNone}</td>;
  return (
    <td className={styles.number} data-metric={metric.id}>
      <Term align="end" definition={<Definition metric={metric} />}>
        {measureDigits(metric.value, metric.unit)}
      </Term>
    </td>
  );
}

function PublishedTable({ statistics, rows }: Pick<Arranged, 'statistics' | 'rows'>) {
  return (
    <table className={styles.table}>
      <caption>{say('Forces and torques on the probe')}</caption>
      <thead>
        <tr>
          <th scope="col">{say('Part')}</th>
          <th scope="col">{say('Unit')}</th>
          {statistics.map((statistic) => (
            <th key={statistic} scope="col" className={styles.number}>
              {say(statistic)}
            </th>
          ))}
        </tr>
      </thead>
      <tbody>
        {rows.map(({ label, symbol, cells }) => (
          <tr key={label}>
            <th scope="row">
              {say(label)}{' '}
              <span className={styles.symbol}>
                {symbol.split('_')[0]}
                <sub>{symbol.split('_')[1]}</sub>
              </span>
            </th>
            <td>{shownUnit(cells.find(Boolean)?.unit ?? '')}</td>
            {cells.map((metric, index) => (
              <Cell key={statistics[index]} metric={metric} />
            ))}
          </tr>
        ))}
      </tbody>
    </table>
  );
}

function Others({ metrics, caption }: { readonly metrics: readonly Metric[]; readonly caption: string }) {
  return (
    <table className={styles.table}>
      <caption>{caption}</caption>
      <thead>
        <tr>
          <th scope="col">{say('Measure')}</th>
          <th scope="col" className={styles.number}>
            {say('Value')}
          </th>
          <th scope="col">{say('Remark')}</th>
        </tr>
      </thead>
      <tbody>
        {metrics.map((metric) => (
          <tr key={metric.id}>
            <th scope="row">
              <Term definition={<Definition metric={metric} />}>{say(metric.label)}</Term>
            </th>
            <td className={styles.number} data-metric={metric.id}>
              {shown(metric)}
            </td>
            <td className={styles.note}>{say(metric.note)}</td>
          </tr>
        ))}
      </tbody>
    </table>
  );
}

/** The measures as the server made them, laid out as in the paper: mean, SD and maximum by part of the wrench. */
export function Measures({ metrics, state }: { readonly metrics: readonly Metric[]; readonly state: TrialState }) {
  const { statistics, rows, others } = arranged(metrics);
  const published = rows.length > 0;
  return (
    <Card title={say('Measures')}>
      {metrics.length > 0 ? (
        <div className={published ? styles.tables : undefined}>
          {published ? (
            <div>
              <PublishedTable statistics={statistics} rows={rows} />
              <p className={styles.foot}>
                {say(
                  'Over the samples above 0.01 N and 0.001 N·m, as in the published tables. Point at a number to see its definition.',
                )}
              </p>
            </div>
          ) : null}
          <Others
            metrics={others}
            caption={published ? say('Further measures') : say('Point at a name to see its definition.')}
          />
        </div>
      ) : state === 'assessing' ? (
        <Skeleton height="220px" />
      ) : (
        <p>{say('This trial has no measures.')}</p>
      )}
    </Card>
  );
}
