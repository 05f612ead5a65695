import { useState } from 'react';
import type { TractMap } from '@/api';
import { PaintedTract, PaintedWall } from '@/charts';
import { say, Sentence } from '@/language';
import { Notice } from '@/ui';
import { formatAngle, formatFigure, formatLength, metre, radian } from '@/units';
import styles from './lab.module.css';

/** The set states a line, not how wide the channel is: drawn as a usual one. */
const kDrawn_m = 0.0025;

/** Error on the wall of the tract: unrolled, and in 3-D. */
export function TractPaint({ map, unit }: { readonly map: TractMap | null; readonly unit: string }) {
  const [pointed, setPointed] = useState('');
  if (!map)
    return (
      <Notice title={say('The positions of the samples in the tract are unknown.')}>
        <Sentence
          text="If set.json states the tract (<code>tract</code> with <code>entry_m</code>, <code>axis</code>, <code>length_m</code>), the error is shown on its wall here."
          parts={{ code: (words) => <code>{words}</code> }}
        />
      </Notice>
    );
  const describe = (depth: number, angle: number, value: number | null) =>
    say('Depth {depth}, angle {angle}: {error}', {
      depth: formatLength(metre(depth)),
      angle: formatAngle(radian(angle)),
      error: value === null ? say('not touched') : formatFigure(value, unit),
    });
  return (
    <div className={styles.stack}>
      <div className={styles.walls}>
        <PaintedWall
          depth_m={map.depth_m}
          angle_rad={map.angle_rad}
          values={map.rmse}
          onPoint={(cell) => setPointed(cell ? describe(cell.depth_m, cell.angle_rad, cell.value) : '')}
          format={(value) => formatFigure(value, unit)}
        />
        <PaintedTract
          depth_m={map.depth_m}
          angle_rad={map.angle_rad}
          values={map.rmse}
          radius_m={kDrawn_m}
          summary={say('Wall of the tract, coloured by the error. The unrolled map shows the same values.')}
        />
      </div>
      <p className={styles.muted} role="status">
        {pointed === ''
          ? say('Point at the unrolled wall to read the error. Angles are measured about the axis of the tract.')
          : pointed}
      </p>
    </div>
  );
}
