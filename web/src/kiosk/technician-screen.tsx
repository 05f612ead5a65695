/** The technician's menu: a self-test, what became of the station's trials, and the commands for what is done at a terminal. */
import { Badge, Button } from '@/ui';
import type { Finding, Send } from './station';
import styles from './kiosk.module.css';

interface Props {
  readonly findings: readonly Finding[];
  readonly log: readonly string[];
  readonly notice: string;
  readonly send: Send;
}

/** What a terminal is for: each asks a person to do something with the device, or changes what a hand may feel. */
const kCommands = [
  'tractus-station self-test',
  'tractus-station calibrate',
  'tractus-station align',
  'tractus-station limits',
  'journalctl -u tractus-kiosk',
] as const;

export function TechnicianScreen({ findings, log, notice, send }: Props) {
  return (
    <section className={styles.technician}>
      <div className={styles.row}>
        <h1>Technician</h1>
        <Button look="solid" onClick={() => send({ command: 'self_test' })}>
          Self-test
        </Button>
        <Button onClick={() => send({ command: 'back' })}>Back</Button>
      </div>
      <p>The self-test here is of a simulated device. A real one is tested at a terminal.</p>
      {notice === '' ? null : <p role="alert">{notice}</p>}
      {findings.length === 0 ? null : (
        <ul className={styles.findings} aria-label="Findings">
          {findings.map(({ name, passed, words }) => (
            <li key={name}>
              <Badge tone={passed ? 'good' : 'bad'}>{passed ? 'passed' : 'NOT passed'}</Badge> {name}
              {passed ? null : `: ${words}`}
            </li>
          ))}
        </ul>
      )}
      <h2>Trials of this station, the newest first</h2>
      {log.length === 0 ? <p>None yet.</p> : null}
      <ul className={styles.findings}>
        {log.map((line) => (
          <li key={line}>{line}</li>
        ))}
      </ul>
      <h2>At a terminal, with the kiosk stopped</h2>
      <p>{kCommands.join(' · ')}</p>
    </section>
  );
}
