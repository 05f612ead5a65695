import { useState, type ChangeEvent } from 'react';
import { marked, say, Sentence } from '@/language';
import { Button, Card, Field, Notice } from '@/ui';
import { kTuned, type Draft, type Tuned, type Uploaded } from './draft';
import styles from './new-study.module.css';

interface Props {
  readonly draft: Draft;
  readonly set: (changes: Partial<Draft>) => void;
}

const kMost_bytes = 1_000_000;

/** A scenario file, or a sentence why it is none; the numbers in it are the server's to judge. */
async function read(file: File): Promise<Uploaded | string> {
  if (file.size > kMost_bytes) return say('{file}: too large for a scenario (limit: 1 MB).', { file: file.name });
  try {
    const json: unknown = JSON.parse(await file.text());
    const scenario = json as Record<string, unknown>;
    if (typeof json === 'object' && json !== null && scenario.format === 'tractus-scenario/1')
      return { file: file.name, scenario };
    return say('{file}: not a tractus-scenario/1 file.', { file: file.name });
  } catch {
    return say('{file}: not valid JSON.', { file: file.name });
  }
}

export function Scenarios({ draft, set }: Props) {
  const [refused, setRefused] = useState<readonly string[]>([]);
  const chosen = (id: Tuned, on: boolean) =>
    set({ tuned: kTuned.map((one) => one.id).filter((one) => (one === id ? on : draft.tuned.includes(one))) });
  const upload = async (event: ChangeEvent<HTMLInputElement>) => {
    const input = event.currentTarget;
    const results = await Promise.all([...(input.files ?? [])].map(read));
    input.value = '';
    setRefused(results.filter((one) => typeof one === 'string'));
    set({ uploaded: [...draft.uploaded, ...results.filter((one) => typeof one !== 'string')] });
  };
  return (
    <Card title={say('Scenarios')}>
      <fieldset className={styles.choices}>
        <legend>{say('Built-in scenarios')}</legend>
        {kTuned.map(({ id, label }) => (
          <label key={id}>
            <input
              type="checkbox"
              checked={draft.tuned.includes(id)}
              onChange={(event) => chosen(id, event.target.checked)}
            />{' '}
            {say(label)}
          </label>
        ))}
      </fieldset>
      <div className={styles.upload}>
        <label htmlFor="scenario-files">
          <Sentence
            text="Custom scenarios (JSON files created with <code>tractus scenario new</code>)"
            parts={{ code: (words) => <code>{words}</code> }}
          />
        </label>
        <input
          id="scenario-files"
          type="file"
          accept=".json,application/json"
          multiple
          onChange={(event) => void upload(event)}
        />
        <ul className={styles.files}>
          {draft.uploaded.map(({ file, scenario }, i) => (
            <li key={`${file}-${i}`}>
              <span>
                {typeof scenario.name === 'string' ? scenario.name : file} <span className={styles.hint}>{file}</span>
              </span>
              <Button
                look="quiet"
                label={say('Remove {name}', { name: file })}
                onClick={() => set({ uploaded: draft.uploaded.filter((_, at) => at !== i) })}
              >
                {say('Remove')}
              </Button>
            </li>
          ))}
        </ul>
        {refused.length > 0 ? (
          <Notice tone="warn" title={say('Rejected files:')}>
            {refused.join(' ')}
          </Notice>
        ) : null}
      </div>
    </Card>
  );
}

const kOrders = [
  {
    id: 'random',
    label: marked('Random'),
    text: marked('Each participant gets all trials in an individual random order, as in the published study.'),
  },
  {
    id: 'balanced',
    label: marked('Balanced'),
    text: marked(
      'In blocks that contain each scenario once, ordered by Williams squares: across participants, each scenario follows each other one equally often.',
    ),
  },
] as const;

const kRepeats = [
  { id: 'at_end', label: marked('at the end of the participant’s order') },
  { id: 'at_once', label: marked('as the participant’s next trial') },
  { id: 'never', label: marked('never') },
] as const;

export function Protocol({ draft, set }: Props) {
  return (
    <Card title={say('Protocol')}>
      <div className={styles.protocol}>
        <Field
          label={say('Repeats of each scenario')}
          type="number"
          min={1}
          max={20}
          step={1}
          required
          value={draft.repeats}
          onChange={(event) => set({ repeats: event.target.value })}
        />
        <fieldset className={styles.orders}>
          <legend>{say('Order')}</legend>
          {kOrders.map(({ id, label, text }) => (
            <label key={id}>
              <input
                type="radio"
                name="ordering"
                checked={draft.ordering === id}
                onChange={() => set({ ordering: id })}
              />
              <span>
                <strong>{say(label)}.</strong> {say(text)}
              </span>
            </label>
          ))}
        </fieldset>
        <div className={styles.select}>
          <label htmlFor="on-invalid">{say('Repeat an invalid trial')}</label>
          <select
            id="on-invalid"
            value={draft.onInvalid}
            onChange={(event) => {
              const found = kRepeats.find(({ id }) => id === event.target.value);
              if (found) set({ onInvalid: found.id });
            }}
          >
            {kRepeats.map(({ id, label }) => (
              <option key={id} value={id}>
                {say(label)}
              </option>
            ))}
          </select>
        </div>
      </div>
    </Card>
  );
}
