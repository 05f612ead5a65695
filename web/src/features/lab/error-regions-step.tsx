import type { Comparison } from '@/api';
import { say } from '@/language';
import { Bar, Card, Scroll, Term } from '@/ui';
import { formatFigure, formatShare } from '@/units';
import type { Drawable } from './compare-step';
import { Series } from './compare-step';
import styles from './lab.module.css';
import { TractPaint } from './tract-paint';
import { channelUnit } from './names';

interface Props {
  readonly drawable: Drawable;
  readonly region: number | null;
  readonly setRegion: (region: number | null) => void;
}

function Regions({
  comparison,
  region,
  setRegion,
}: {
  readonly comparison: Comparison;
  readonly region: number | null;
  readonly setRegion: (region: number | null) => void;
}) {
  const unit = channelUnit(comparison.primary);
  if (comparison.where.length === 0)
    return (
      <p>{say('The error is spread evenly: no region has a clearly larger share of the error than of the time.')}</p>
    );
  return (
    <Scroll label={say('Regions with the largest error')}>
      <table className={styles.table} data-part="regions">
        <caption className="hidden-visually">{say('Regions with the largest error')}</caption>
        <thead>
          <tr>
            <th scope="col">{say('Region')}</th>
            <th scope="col">{say('Share of the error')}</th>
            <th scope="col">{say('Share of the time')}</th>
            <th scope="col" className={styles.number}>
              {say('Error')}
            </th>
            <th scope="col" className={styles.number}>
              <Term
                align="end"
                definition={say(
                  'Mean of measured − simulated in the region. Positive: the force of the model is too small. Negative: it is too large.',
                )}
              >
                {say('Mean residual')}
              </Term>
            </th>
          </tr>
        </thead>
        <tbody>
          {comparison.where.map((one, i) => (
            <tr key={one.region} data-chosen={i === region || undefined}>
              <th scope="row">
                <button
                  type="button"
                  className={styles.rowButton}
                  aria-pressed={i === region}
                  onClick={() => setRegion(i === region ? null : i)}
                >
                  {one.words === '' ? say('everywhere') : one.words}
                </button>
              </th>
              <td>
                <span className={styles.bar}>
                  <Bar share={one.share_of_error} tone="bad" />
                  <span>{formatShare(one.share_of_error)}</span>
                </span>
              </td>
              <td>
                <span className={styles.bar}>
                  <Bar share={one.share_of_time} tone="muted" />
                  <span>{formatShare(one.share_of_time)}</span>
                </span>
              </td>
              <td className={styles.number}>{formatFigure(one.rmse, unit)}</td>
              <td className={styles.number}>
                {one.mean.map((value) => formatFigure(value, one.mean.length > 1 ? '' : unit, 2)).join(', ')}
              </td>
            </tr>
          ))}
        </tbody>
      </table>
    </Scroll>
  );
}

/** The regions with the largest error, and the samples of each. */
export function ErrorRegionsStep({ drawable, region, setRegion }: Props) {
  const { before, run, rig } = drawable;
  const chosen = region === null ? undefined : before.where[region];
  return (
    <>
      <Card
        title={say('Error regions')}
        aside={
          <Term
            align="end"
            definition={say('Shallow regression tree on depth, direction, speed and phase; {method}.', {
              method: before.where_method,
            })}
          >
            {say('method')}
          </Term>
        }
      >
        <Regions comparison={before} region={region} setRegion={setRegion} />
        {before.where.length > 0 ? (
          <p className={styles.muted}>{say('Select a region to see its samples below.')}</p>
        ) : null}
      </Card>
      {rig === 'palpation' ? (
        <Card title={say('Error on the wall of the tract')}>
          <TractPaint map={run.tract_map} unit={channelUnit(before.primary)} />
        </Card>
      ) : null}
      <Card title={chosen ? say('Samples where {condition}', { condition: chosen.words }) : say('Samples')}>
        <Series drawable={drawable} region={region} />
      </Card>
    </>
  );
}
