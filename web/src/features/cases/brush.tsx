import { useId } from 'react';
import { say } from '@/language';
import { Button } from '@/ui';
import { formatLength, metre } from '@/units';
import styles from './cases.module.css';
import { kBrushes, kMostMarks, type Brush, type Tool } from './plan';

const kRadius_mm = { least: 1, most: 8, step: 0.5 } as const;

const nameOf = (brush: Brush) =>
  ({ bone: say('Bone here'), no_bone: say('No bone here'), erase: say('Remove marks here') })[brush];

/** The brushes that correct the envelope: what they paint, how large they are, and how to take all marks back. */
export function BrushFields({
  chosen,
  radius_m,
  marks,
  onChoose,
  onRadius,
  onRemove,
}: {
  readonly chosen: Tool;
  readonly radius_m: number;
  /** How many there are. */ readonly marks: number;
  readonly onChoose: (tool: Tool) => void;
  readonly onRadius: (radius_m: number) => void;
  readonly onRemove: () => void;
}) {
  const id = useId();
  return (
    <div className={styles.point} data-part="brush">
      <div className={styles.brushes}>
        {kBrushes.map((brush) => (
          <label key={brush} className={styles.choose}>
            <input type="radio" name="end" checked={chosen === brush} onChange={() => onChoose(brush)} />
            <span className={styles.sign} data-brush={brush} aria-hidden="true" />
            {nameOf(brush)}
          </label>
        ))}
      </div>
      <div className={styles.radius}>
        <label htmlFor={id}>{say('Brush radius')}</label>
        <input
          id={id}
          type="range"
          min={kRadius_mm.least}
          max={kRadius_mm.most}
          step={kRadius_mm.step}
          value={radius_m * 1000}
          aria-valuetext={formatLength(metre(radius_m))}
          onChange={(event) => onRadius(Number(event.target.value) / 1000)}
        />
        <span aria-hidden="true">{formatLength(metre(radius_m))}</span>
      </div>
      <div className={styles.painted}>
        <span role="status">
          {marks < kMostMarks
            ? say('{marks, plural, one {# mark} other {# marks}} on the envelope', { marks })
            : say('{most} marks are the most that there can be: remove some, or undo.', { most: kMostMarks })}
        </span>
        <Button disabled={marks === 0} onClick={onRemove}>
          {say('Remove all marks')}
        </Button>
      </div>
    </div>
  );
}
