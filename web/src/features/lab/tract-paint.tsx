import { useState } from 'react';
import type { TractMap } from '@/api';
import { PaintedWall } from '@/charts';
import { Notice } from '@/ui';
import { formatAngle, formatFigure, formatLength, metre, radian } from '@/units';
import styles from './lab.module.css';

/** The error of a palpation painted on the wall of its tract: unrolled, and round about in 3-D. */
export function TractPaint({ map, unit }: { readonly map: TractMap | null; readonly unit: string }) {
  const [pointed, setPointed] = useState('');
  if (!map) return <Notice title="The place of the samples in the tract is not known.">A set that states its tract (<code>"tract"</code> in set.json: entry, axis, length, radius, medial and superior) has its error painted on the wall here.</Notice>;
  const said = (depth: number, angle: number, value: number | null) =>
    `${formatLength(metre(depth))} deep at ${formatAngle(radian(angle))}: ${value === null ? 'not touched' : formatFigure(value, unit)}`;
  return (
    <div className={styles.stack}>
      <PaintedWall depth_m={map.depth_m} angle_rad={map.angle_rad} values={map.rmse} onPoint={(cell) => setPointed(cell ? said(cell.depth_m, cell.angle_rad, cell.value) : '')}
        format={(value) => formatFigure(value, unit)} />
      <p className={styles.muted} role="status">{pointed === '' ? 'Point at the wall to read the error there.' : pointed}</p>
    </div>
  );
}
