import { useState } from 'react';
import type { TractMap } from '@/api';
import { PaintedTract, PaintedWall } from '@/charts';
import { Notice } from '@/ui';
import { formatAngle, formatFigure, formatLength, metre, radian } from '@/units';
import styles from './lab.module.css';

/** The set states a line, not how wide the channel is: drawn as a usual one. */
const kDrawn_m = 0.0025;

/** The error of a palpation painted on the wall of its tract: unrolled, and round about in 3-D. */
export function TractPaint({ map, unit }: { readonly map: TractMap | null; readonly unit: string }) {
  const [pointed, setPointed] = useState('');
  if (!map) return <Notice title="The place of the samples in the tract is not known.">A set that states its tract (<code>&quot;tract&quot;</code> in set.json: <code>entry_m</code>, <code>axis</code>, <code>length_m</code>) has its error painted on the wall here.</Notice>;
  const said = (depth: number, angle: number, value: number | null) =>
    `${formatLength(metre(depth))} deep at ${formatAngle(radian(angle))}: ${value === null ? 'not touched' : formatFigure(value, unit)}`;
  return (
    <div className={styles.stack}>
      <div className={styles.walls}>
        <PaintedWall depth_m={map.depth_m} angle_rad={map.angle_rad} values={map.rmse} onPoint={(cell) => setPointed(cell ? said(cell.depth_m, cell.angle_rad, cell.value) : '')}
          format={(value) => formatFigure(value, unit)} />
        <PaintedTract depth_m={map.depth_m} angle_rad={map.angle_rad} values={map.rmse} radius_m={kDrawn_m} summary="Wall of the tract, coloured by the error; the unrolled map beside it has the same numbers." />
      </div>
      <p className={styles.muted} role="status">{pointed === '' ? 'Point at the unrolled wall to read the error there. Angles are about the tract’s axis.' : pointed}</p>
    </div>
  );
}
