/** The technician's menu: a self-test, limits, version, what became of the trials, the log, and what is done at a terminal. */
import { marked, say } from '@/language';
import { Badge, Button } from '@/ui';
import { formatFigure } from '@/units';
import type { About, Finding, Send } from './station';
import styles from './kiosk.module.css';

interface Props {
  readonly findings: readonly Finding[];
  readonly trials: readonly string[];
  readonly log: readonly string[];
  readonly about?: About | undefined;
  readonly notice: string;
  readonly send: Send;
}

/** What a terminal is for, and why not here. */
const kCommands = [
  ['tractus-station calibrate', marked('the handle looks for its zero by itself; who does it is kept with the date')],
  [
    'tractus-station align',
    marked('a fixture is touched with the tip while the headset is worn; this screen is not seen'),
  ],
  [
    'tractus-station limits --restore',
    marked('raises what was lowered from afar: a decision that is made beside the device'),
  ],
  ['journalctl -u tractus-kiosk', marked('the whole log')],
] as const;

/** Words and unit of each limit that a station states. */
const kLimits: Readonly<Record<string, readonly [words: string, unit: string]>> = {
  max_force_N: [marked('largest force'), 'N'],
  max_torque_Nm: [marked('largest torque'), 'N·m'],
  max_force_slew_N_per_s: [marked('fastest change of force'), 'N/s'],
  max_torque_slew_Nm_per_s: [marked('fastest change of torque'), 'N·m/s'],
  max_speed_m_s: [marked('fastest motion'), 'm/s'],
  max_turn_rad_s: [marked('fastest turning'), 'rad/s'],
  max_jump_m: [marked('largest jump between two samples'), 'm'],
  ramp_s: [marked('ramp after arming'), 's'],
  max_push_N: [marked('largest push of the hand'), 'N'],
};

function Limits({ limits, lowered_force_N }: Pick<About, 'limits' | 'lowered_force_N'>) {
  return (
    <ul className={styles.findings} aria-label={say('Limits')}>
      {Object.entries(limits).map(([key, value]) => {
        const [words, unit] = kLimits[key] ?? [key, ''];
        return (
          <li key={key}>
            {say(words)}: {formatFigure(value, unit)}
          </li>
        );
      })}
      {lowered_force_N === null ? null : (
        <li>{say('lowered from afar to {force}', { force: formatFigure(lowered_force_N, 'N') })}</li>
      )}
    </ul>
  );
}

function Lines({ title, lines }: { readonly title: string; readonly lines: readonly string[] }) {
  return (
    <>
      <h2>{title}</h2>
      {lines.length === 0 ? <p>{say('None yet.')}</p> : null}
      <ul className={styles.lines} aria-label={title}>
        {lines.map((line) => (
          <li key={line}>{line}</li>
        ))}
      </ul>
    </>
  );
}

export function TechnicianScreen({ findings, trials, log, about, notice, send }: Props) {
  return (
    <section className={styles.technician}>
      <div className={styles.row}>
        <h1>{say('Technician')}</h1>
        <Button look="solid" onClick={() => send({ command: 'self_test' })}>
          {say('Self-test')}
        </Button>
        <Button onClick={() => send({ command: 'back' })}>{say('Back')}</Button>
      </div>
      {notice === '' ? null : <p role="alert">{notice}</p>}
      {findings.length === 0 ? null : (
        <ul className={styles.findings} aria-label={say('Findings')}>
          {findings.map(({ name, passed, words }) => (
            <li key={name}>
              <Badge tone={passed ? 'good' : 'bad'}>{passed ? say('passed') : say('NOT passed')}</Badge> {name}
              {passed ? null : `: ${words}`}
            </li>
          ))}
        </ul>
      )}
      {about === undefined ? null : (
        <p>
          {say(
            '{station}, device {device}, version {version}. To update: install the new version at a terminal, then systemctl restart tractus-kiosk. Trials that wait stay on the disk.',
            { station: about.station, device: about.device, version: about.version },
          )}
        </p>
      )}
      <div className={styles.halves}>
        <div>
          <h2>{say('Limits')}</h2>
          {about === undefined ? null : <Limits {...about} />}
        </div>
        <div>
          <h2>{say('At a terminal, with the kiosk stopped')}</h2>
          <ul className={styles.lines}>
            {kCommands.map(([command, why]) => (
              <li key={command}>
                <code>{command}</code>: {say(why)}
              </li>
            ))}
          </ul>
        </div>
      </div>
      <div className={styles.halves}>
        <div>
          <Lines title={say('Trials, the newest first')} lines={trials} />
        </div>
        <div>
          <Lines title={say('Log, the newest first')} lines={log} />
        </div>
      </div>
    </section>
  );
}

/** A self-test: what will move and what to do, before it moves. */
export function TestScreen({
  text,
  waits,
  send,
}: {
  readonly text: string;
  readonly waits: boolean;
  readonly send: Send;
}) {
  return (
    <section className={styles.centre} role="status">
      <h1>{say('Self-test')}</h1>
      <p>{text === '' ? say('The checks run…') : text}</p>
      {waits ? (
        <Button look="solid" className={styles.main_button} onClick={() => send({ command: 'confirm' })}>
          {say('Done: go on')}
        </Button>
      ) : null}
      <Button className={styles.wide} onClick={() => send({ command: 'stop_test' })}>
        {say('Stop')}
      </Button>
    </section>
  );
}
