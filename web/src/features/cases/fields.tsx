import { useState } from 'react';
import { kWalls, type Vec3 } from '@/api';
import { marked, say } from '@/language';
import { Field, Select, wallName } from '@/ui';
import styles from './cases.module.css';
import { kBreachDepth_mm, type Breach, type End, type Plan, type Preparation } from './plan';

const kAxes = [marked('x (left)'), marked('y (back)'), marked('z (up)')] as const;
const inMillimetres = (value: number | undefined | null) =>
  value === undefined || value === null ? '' : String(Math.round(value * 1e5) / 100);

/** A number in millimetres. Every number is passed on, also one that is not allowed: no page goes on with an older one. */
export function Millimetres({
  label,
  value_m,
  min = -2000,
  max = 2000,
  step = 0.5,
  required = true,
  onValue,
}: {
  readonly label: string;
  readonly value_m: number | null;
  readonly min?: number;
  readonly max?: number;
  readonly step?: number;
  readonly required?: boolean;
  readonly onValue: (value_m: number | null) => void;
}) {
  const [typed, setTyped] = useState<string | null>(null);
  const text = typed ?? inMillimetres(value_m);
  const wrong = text !== '' && !(Number.isFinite(Number(text)) && Number(text) >= min && Number(text) <= max);
  return (
    <Field
      label={label}
      type="number"
      inputMode="decimal"
      step={step}
      min={min}
      max={max}
      value={text}
      error={wrong ? say('Enter a value from {min} to {max} mm.', { min, max }) : ''}
      required={required}
      onBlur={() => setTyped(null)}
      onChange={(event) => {
        const next = event.target.value;
        setTyped(next);
        if (next === '') {
          if (!required) onValue(null);
          return;
        }
        const number = Number(next);
        if (Number.isFinite(number)) onValue(number / 1000);
      }}
    />
  );
}

export function PointFields({
  end,
  at,
  chosen,
  onChoose,
  onAt,
}: {
  readonly end: End;
  readonly at: Vec3 | null;
  readonly chosen: boolean;
  readonly onChoose: () => void;
  readonly onAt: (at: Vec3) => void;
}) {
  const place = (axis: number, value: number | null) => {
    if (value === null) return;
    const from = at ?? [0, 0, 0];
    onAt([axis === 0 ? value : from[0], axis === 1 ? value : from[1], axis === 2 ? value : from[2]]);
  };
  return (
    <div className={styles.point} data-end={end}>
      <label className={styles.choose}>
        <input type="radio" name="end" checked={chosen} onChange={onChoose} />{' '}
        {end === 'entry' ? say('Entry') : say('Target')}
      </label>
      <div className={styles.three}>
        {kAxes.map((axis, i) => (
          <Millimetres
            key={axis}
            label={say('{axis}, mm', { axis: say(axis) })}
            value_m={at?.[i] ?? null}
            onValue={(value) => place(i, value)}
          />
        ))}
      </div>
    </div>
  );
}

export function BreachFields({
  plan,
  length_m,
  onBreach,
  onWhole,
  onPreparation,
}: {
  readonly plan: Plan;
  readonly length_m: number | null;
  readonly onBreach: (breach: Breach | null) => void;
  readonly onWhole: (whole: boolean) => void;
  readonly onPreparation: (preparation: Preparation) => void;
}) {
  const { breach } = plan;
  const longest_mm = Math.max(1, Math.floor((length_m ?? 0.1) * 1000));
  return (
    <div className={styles.breach}>
      <Select
        label={say('Channel')}
        value={plan.whole ? 'planned' : 'drilled'}
        options={[
          { value: 'drilled', text: say('pre-drilled') },
          { value: 'planned', text: say('trainee drills') },
        ]}
        onChange={(event) => onWhole(event.target.value === 'planned')}
      />
      <Select
        label={say('Bone')}
        value={plan.preparation}
        options={[
          { value: 'filled', text: say('filled: all of it is felt') },
          { value: 'published', text: say('published: marrow is not felt') },
        ]}
        onChange={(event) => onPreparation(event.target.value === 'published' ? 'published' : 'filled')}
      />
      {plan.whole ? null : (
        <Select
          label={say('Breach')}
          value={breach?.wall ?? ''}
          options={[{ value: '', text: say('none') }, ...kWalls.map((wall) => ({ value: wall, text: wallName(wall) }))]}
          onChange={(event) => {
            const wall = kWalls.find((one) => one === event.target.value);
            onBreach(
              wall
                ? { wall, depth_m: breach?.depth_m ?? 0.003, at_m: wall === 'anterior' ? null : (breach?.at_m ?? null) }
                : null,
            );
          }}
        />
      )}
      {breach ? (
        <Millimetres
          label={say('Depth beyond the bone, mm')}
          value_m={breach.depth_m}
          min={kBreachDepth_mm.least}
          max={kBreachDepth_mm.most}
          onValue={(depth_m) => {
            if (depth_m !== null) onBreach({ ...breach, depth_m });
          }}
        />
      ) : null}
      {breach && breach.wall !== 'anterior' ? (
        <Millimetres
          label={say('At depth, mm (empty: where it is told best)')}
          value_m={breach.at_m}
          min={0}
          max={longest_mm}
          required={false}
          onValue={(at_m) => onBreach({ ...breach, at_m })}
        />
      ) : null}
    </div>
  );
}
