import { useMutation, useQuery } from '@tanstack/react-query';
import { useState } from 'react';
import { addMeasurements, type MeasurementSet } from '@/api';
import { marked, say } from '@/language';
import { Button, Field, Notice, Select, useSettled } from '@/ui';
import { formatCount, formatTime, second } from '@/units';
import { kColumns, kUnits, missing, probingFiles, probingTrial, type Choices, type Chosen, type Column } from './made';
import type { Clock, Recording } from './mcap';
import styles from './recording.module.css';
import { ChannelPicture } from './channel-picture';
import { zipped } from './zipped';

const kMeanings = {
  x_m: marked('Depth of the tip from the entry, positive into the bone'),
  theta_rad: marked('Angle by which the probe is turned about its axis'),
  fz_N: marked('Push of the hand along the axis, positive into the bone'),
  tz_Nm: marked('Torque of the hand about the axis'),
} as const;
const kColumnUnits = { x_m: 'm', theta_rad: 'rad', fz_N: 'N', tz_Nm: 'Nm' } as const;
const kPace_ms = 400;

interface ColumnProps {
  readonly recording: Recording;
  readonly column: Column;
  readonly chosen: Chosen | undefined;
  readonly set: (chosen: Chosen | undefined) => void;
}

/** Which field is a column, in what unit, from where it counts and which way. */
function ColumnChoice({ recording, column, chosen, set }: ColumnProps) {
  const [zero, setZero] = useState('0');
  const options = recording.topics.flatMap((topic, t) =>
    topic.fields.map(({ path, unit }, f) => ({
      value: `${t}/${f}`,
      text: `${topic.name} ${path}${unit === null ? '' : ` (${unit})`}`,
    })),
  );
  const pick = (value: string) => {
    const [t = -1, f = -1] = value === '' ? [] : value.split('/').map(Number);
    const topic = recording.topics[t];
    const field = topic?.fields[f];
    if (!topic || !field) return set(undefined);
    const unit = field.unit !== null && field.unit in kUnits[column] ? field.unit : Object.keys(kUnits[column])[0];
    set({ topic, path: field.path, unit: unit ?? '', zero: Number(zero) || 0, reversed: chosen?.reversed ?? false });
  };
  const index = chosen
    ? `${recording.topics.indexOf(chosen.topic)}/${chosen.topic.fields.findIndex(({ path }) => path === chosen.path)}`
    : '';
  return (
    <fieldset className={styles.columns}>
      <legend>
        <code>{column}</code> {say(kMeanings[column])}
      </legend>
      <div className={styles.row}>
        <Select
          label={say('Field of {column}', { column })}
          value={index}
          options={[{ value: '', text: say('not recorded') }, ...options]}
          onChange={(event) => pick(event.target.value)}
        />
        {chosen ? (
          <>
            <Select
              label={say('Recorded in')}
              value={chosen.unit}
              options={Object.keys(kUnits[column]).map((unit) => ({ value: unit, text: unit }))}
              onChange={(event) => set({ ...chosen, unit: event.target.value })}
            />
            <Field
              label={say('Zero at, in that unit')}
              value={zero}
              inputMode="decimal"
              error={Number.isFinite(Number(zero)) ? '' : say('A number is expected.')}
              onChange={(event) => {
                setZero(event.target.value);
                if (Number.isFinite(Number(event.target.value))) set({ ...chosen, zero: Number(event.target.value) });
              }}
            />
            <label>
              <input
                type="checkbox"
                checked={chosen.reversed}
                onChange={(event) => set({ ...chosen, reversed: event.target.checked })}
              />{' '}
              {say('Opposite sign')}
            </label>
          </>
        ) : null}
      </div>
    </fieldset>
  );
}

interface Props {
  readonly recording: Recording;
  readonly clock: Clock;
  readonly onAdded: (set: MeasurementSet) => void;
}

const bound = (text: string, none: number) => (text.trim() === '' ? none : Number(text));

/** From chosen fields to a set of the probing rig, shown before it is added. */
export function ProbingForm({ recording, clock, onAdded }: Props) {
  const [choices, setChoices] = useState<Choices>({});
  const [from, setFrom] = useState('');
  const [to, setTo] = useState('');
  const part = { clock, from_s: bound(from, -Infinity), to_s: bound(to, Infinity) };
  const wish = useSettled({ choices, part }, kPace_ms);
  const lacking = missing(wish.choices);
  const trial = useQuery({
    queryKey: ['recording', recording.name, JSON.stringify(wish, (_, value: unknown) => value ?? 'none')],
    queryFn: () => probingTrial(recording, wish.choices, wish.part),
    enabled: lacking === null,
    retry: false,
    gcTime: 0,
  });
  const added = useMutation({
    mutationFn: async () => {
      if (!trial.data) throw new Error(lacking ?? '');
      return addMeasurements(recording.name.replace(/\.mcap$/i, ''), await zipped(probingFiles(trial.data)));
    },
    onSuccess: onAdded,
  });
  return (
    <div className={styles.form}>
      {kColumns.map((column) => (
        <ColumnChoice
          key={column}
          recording={recording}
          column={column}
          chosen={choices[column]}
          set={(chosen) => setChoices((others) => ({ ...others, [column]: chosen }))}
        />
      ))}
      <div className={styles.row}>
        <Field
          label={say('From, in s (optional)')}
          value={from}
          inputMode="decimal"
          onChange={(e) => setFrom(e.target.value)}
        />
        <Field
          label={say('To, in s (optional)')}
          value={to}
          inputMode="decimal"
          onChange={(e) => setTo(e.target.value)}
        />
      </div>
      {lacking === null ? null : <p className={styles.unread}>{lacking}</p>}
      {lacking === null && trial.isError ? (
        <Notice tone="bad" title={say('These fields make no set.')}>
          {trial.error.message}
        </Notice>
      ) : null}
      {lacking === null && trial.data ? (
        <>
          {trial.data.columns.map(([name, values]) => (
            <ChannelPicture key={name} name={name} unit={kColumnUnits[name]} values={values} />
          ))}
          <p className={styles.unread}>
            {say(
              '{count} rows over {time}, at the stamps of the force’s topic. Other topics are interpolated linearly between their neighbouring messages.',
              { count: formatCount(trial.data.t_s.length), time: formatTime(second(trial.data.t_s.at(-1) ?? 0)) },
            )}
          </p>
        </>
      ) : null}
      {added.isError ? (
        <Notice tone="bad" title={say('The measurements were not added.')}>
          {added.error.message}
        </Notice>
      ) : null}
      <div>
        <Button
          look="solid"
          disabled={lacking !== null || !trial.data || trial.isFetching || added.isPending}
          onClick={() => added.mutate()}
        >
          {added.isPending ? say('Packing, uploading and checking the files…') : say('Add to the measurements')}
        </Button>
      </div>
    </div>
  );
}
