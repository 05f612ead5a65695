import { useSyncExternalStore } from 'react';
import { say } from '@/language';
import { axisTitle, formatTime, kNone, rounded, second, united, type Quantity } from '@/units';
import type { Cursor } from './cursor';
import styles from './signal-chart.module.css';
import type { Panel } from './signal-types';
import { lowerBound, type Detail } from './tiles';

function nearest(t: readonly number[], moment: number): number {
  const after = lowerBound(t, moment);
  if (after === 0) return 0;
  if (after >= t.length) return t.length - 1;
  return moment - (t[after - 1] ?? 0) < (t[after] ?? 0) - moment ? after - 1 : after;
}

/** "0.42 N", or "0.10…0.42 N" where a drawn point stands for several samples. */
function rangeText(least: number | null | undefined, greatest: number | null | undefined, quantity: Quantity): string {
  if (least === null || least === undefined || greatest === null || greatest === undefined) return kNone;
  const low = rounded(least, quantity),
    high = rounded(greatest, quantity);
  return united(low === high ? high : `${low} … ${high}`, quantity);
}

/** Legend of a panel, with the values under the pointer. */
export function Readout({
  panel,
  detail,
  cursor,
}: {
  readonly panel: Panel;
  readonly detail: Detail;
  readonly cursor: Cursor;
}) {
  const moment = useSyncExternalStore(cursor.subscribe, cursor.now);
  const at = moment === null || detail.t.length === 0 ? null : nearest(detail.t, moment);
  return (
    <div className={styles.legend}>
      <h3 className={styles.panelTitle}>{axisTitle(panel.title, panel.quantity)}</h3>
      <ul>
        {panel.traces.map((trace) => (
          <li key={trace.channel}>
            <span className={styles.swatch} style={{ background: `var(${trace.colour})` }} />
            <span>
              {trace.label}
              {trace.symbol ? (
                <>
                  {' '}
                  <i>
                    {trace.symbol[0]}
                    <sub>{trace.symbol[1]}</sub>
                  </i>
                </>
              ) : null}
            </span>
            <span className={styles.value} data-channel={trace.channel}>
              {at === null
                ? ''
                : rangeText(
                    detail.channels[trace.channel]?.min[at],
                    detail.channels[trace.channel]?.max[at],
                    panel.quantity,
                  )}
            </span>
          </li>
        ))}
      </ul>
    </div>
  );
}

/** The moment under the pointer, in the chart's tool bar. */
export function Moment({ cursor }: { readonly cursor: Cursor }) {
  const moment = useSyncExternalStore(cursor.subscribe, cursor.now);
  return (
    <span className={styles.moment}>
      {moment === null ? '' : say('at {time}', { time: formatTime(second(moment), 3) })}
    </span>
  );
}
