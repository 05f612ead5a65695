import { useId, useState } from 'react';
import type { ScenarioCheck, ScenarioFile } from '@/api';
import { say } from '@/language';
import { Button } from '@/ui';
import { formatCount } from '@/units';
import {
  fromShown,
  inMillimetres,
  inUnitsOf,
  shown,
  valueAt,
  withLayer,
  withValue,
  withWall,
  type Knob,
} from './draft';
import styles from './scenarios.module.css';

interface Props {
  readonly file: ScenarioFile;
  readonly check: ScenarioCheck | undefined;
  readonly onFile: (file: ScenarioFile) => void;
}

/** One number; the server's error message is shown below it. */
function Number_({ knob, file, check, onFile }: Props & { readonly knob: Knob }) {
  const [typed, setTyped] = useState<string | null>(null);
  const id = useId();
  const value = valueAt(file, knob.pointer);
  const text = typed ?? (typeof value === 'number' ? shown(value, knob) : '');
  const none = text.trim() === '' || !Number.isFinite(Number(text));
  const refused = check && !check.ok && check.field === knob.pointer ? inUnitsOf(check.error, knob) : '';
  const wrong = none ? say('Enter a number.') : refused;
  return (
    <div className={styles.knob}>
      <label htmlFor={id}>
        {say(knob.label)}
        {knob.unit === '' ? '' : <span className={styles.unit}>, {knob.unit}</span>}
      </label>
      <input
        id={id}
        type="number"
        step={knob.step}
        value={text}
        aria-invalid={wrong !== '' || undefined}
        aria-describedby={`${id}-description`}
        onBlur={() => {
          if (!none) setTyped(null);
        }}
        onChange={(event) => {
          setTyped(event.target.value);
          if (event.target.value.trim() !== '' && Number.isFinite(Number(event.target.value)))
            onFile(withValue(file, knob.pointer, fromShown(event.target.value, knob)));
        }}
      />
      <p id={`${id}-description`} className={wrong === '' ? styles.means : styles.wrong}>
        {wrong === '' ? say(knob.description) : wrong}
      </p>
    </div>
  );
}

export function Knobs({ knobs, ...rest }: Props & { readonly knobs: readonly Knob[] }) {
  return (
    <div className={styles.knobs}>
      {knobs.map((knob) => (
        <Number_ key={knob.pointer} knob={knob} {...rest} />
      ))}
    </div>
  );
}

const kDepth = { unit: 'mm', times: 1e3, step: 0.5, symbol: '' } as const;

/** Depths of the walls. */
export function Walls(props: Props) {
  const { file, check, onFile } = props;
  const all = check && !check.ok && check.field === '/walls_m' ? check.error : '';
  return (
    <div className={styles.stack}>
      {file.walls_m.map((_, i) => (
        <div key={i} className={styles.row}>
          <Number_
            {...props}
            knob={{
              ...kDepth,
              pointer: `/walls_m/${i}`,
              label: say('Wall {number} at depth', { number: formatCount(i + 1) }),
              description: say('depth of the breach'),
            }}
          />
          <Button
            look="quiet"
            label={say('Remove wall {number}', { number: formatCount(i + 1) })}
            onClick={() => onFile({ ...file, walls_m: file.walls_m.filter((__, k) => k !== i) })}
          >
            {say('Remove')}
          </Button>
        </div>
      ))}
      {all === '' ? null : <p className={styles.wrong}>{inMillimetres(all)}</p>}
      {file.walls_m.length === 0 ? <p className={styles.means}>{say('No walls: there is no breach.')}</p> : null}
      <div>
        <Button onClick={() => onFile(withWall(file))} disabled={file.walls_m.length >= 8}>
          {say('Add wall')}
        </Button>
      </div>
    </div>
  );
}

/** Regions that are denser or less dense than the rest of the bone. */
export function Layers(props: Props) {
  const { file, check, onFile } = props;
  const at = (i: number, field: string) => `/layers/${i}/${field}`;
  const all = check && !check.ok && /^\/layers(\/\d+)?$/.test(check.field) ? check.error : '';
  return (
    <div className={styles.stack}>
      {file.layers.map((_, i) => (
        <div key={i} className={styles.stretch}>
          <Number_
            {...props}
            knob={{
              ...kDepth,
              pointer: at(i, 'start_m'),
              label: say('Region {number} from', { number: formatCount(i + 1) }),
              description: say('depth'),
            }}
          />
          <Number_
            {...props}
            knob={{
              ...kDepth,
              pointer: at(i, 'thickness_m'),
              label: say('thickness'),
              description: say('along the depth'),
            }}
          />
          <Number_
            {...props}
            knob={{
              unit: '',
              times: 1,
              step: 0.1,
              symbol: '',
              pointer: at(i, 'density'),
              label: say('density'),
              description: say('relative to the rest of the bone'),
            }}
          />
          <Button
            look="quiet"
            label={say('Remove region {number}', { number: formatCount(i + 1) })}
            onClick={() => onFile({ ...file, layers: file.layers.filter((__, k) => k !== i) })}
          >
            {say('Remove')}
          </Button>
        </div>
      ))}
      {all === '' ? null : <p className={styles.wrong}>{inMillimetres(all)}</p>}
      {file.layers.length === 0 ? <p className={styles.means}>{say('The density is the same everywhere.')}</p> : null}
      <div>
        <Button onClick={() => onFile(withLayer(file))} disabled={file.layers.length >= 12 || withLayer(file) === file}>
          {say('Add region')}
        </Button>
      </div>
    </div>
  );
}
