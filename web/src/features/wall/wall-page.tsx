import { useQuery } from '@tanstack/react-query';
import { useState } from 'react';
import { Link } from 'wouter';
import { sessionQuery, stopStation, type StationState } from '@/api';
import { Badge, Button, Notice, ReasonDialog, Skeleton, useTitle } from '@/ui';
import { formatDateTime, formatDuration, formatForce, formatLength, newton, metre, second } from '@/units';
import { useLive } from './use-live';
import styles from './wall.module.css';
import { inOrder, inShort, isAtWork, kStates } from './words';

function Trial({ trial }: { readonly trial: NonNullable<StationState['trial']> }) {
  return (
    <dl className={styles.facts}>
      <div><dt>Who</dt><dd>{trial.person ?? 'somebody of another cohort'}</dd></div>
      {trial.case_title === null ? null : <div><dt>Case</dt><dd>{trial.case_title}</dd></div>}
      <div><dt>Time</dt><dd className={styles.number}>{formatDuration(second(trial.t_s))}</dd></div>
      {trial.force_N === null ? null : <div><dt>Force</dt><dd className={styles.number}>{formatForce(newton(trial.force_N))}</dd></div>}
      {trial.depth_m === null ? null : <div><dt>Depth</dt><dd className={styles.number}>{formatLength(metre(trial.depth_m))}</dd></div>}
      {trial.late_ticks > 0 ? <div><dt>Late steps</dt><dd className={styles.number}>{trial.late_ticks}</dd></div> : null}
    </dl>
  );
}

function since(station: StationState): string {
  if (station.state === 'away') return station.last_seen_utc_us === null ? 'never heard of' : `last heard of ${formatDateTime(station.last_seen_utc_us)}`;
  return station.since_utc_us === null || station.since_utc_us === 0 ? '' : `since ${formatDateTime(station.since_utc_us)}`;
}

function Tile({ station, named, onStop }: { readonly station: StationState; readonly named: boolean; readonly onStop: () => void }) {
  const word = kStates[station.state];
  return (
    <li className={styles.tile} data-tone={word.tone} data-station={station.name}>
      <div className={styles.head}>
        <h2 className={styles.name}>{named ? <Link href={`/network/stations/${station.id}`}>{station.name}</Link> : station.name}</h2>
        <Badge tone={word.tone}>{word.name}</Badge>
      </div>
      <p className={styles.muted}>{since(station)} {station.simulated === true ? <Badge tone="warn">simulated device</Badge> : null}</p>
      {station.trial === null ? <p className={styles.means}>{word.means}</p> : <Trial trial={station.trial} />}
      {(station.waiting_trials ?? 0) > 0 ? <p className={styles.muted}>{station.waiting_trials} trials wait to be handed over</p> : null}
      {station.self_test?.passed === false ? <p><Badge tone="bad">self-test failed</Badge> <span className={styles.muted}>{station.self_test.failed.join(', ')}</span></p> : null}
      <div className={styles.deeds}>{isAtWork(station) ? <Button label={`Stop ${station.name}`} onClick={onStop}>Stop…</Button> : null}</div>
    </li>
  );
}

const kLine = {
  connecting: { tone: 'info', title: 'Reaching the server…', text: 'The stations are shown as soon as the line stands.' },
  lost: { tone: 'warn', title: 'The line to the server is lost; it is tried again by itself.', text: 'What stands below is how things were when it was lost. The stations go on by themselves.' },
} as const;

/** Every station at a glance, as it is now. */
export function WallPage() {
  useTitle('Stations live');
  const { line, stations } = useLive();
  const role = useQuery({ ...sessionQuery, enabled: false }).data?.role;
  const [stopping, setStopping] = useState<StationState | null>(null);
  const said = line === 'open' ? null : kLine[line];
  return (
    <div className={styles.page}>
      <div>
        <h1>Stations live</h1>
        <p className={styles.lead} role="status" data-part="in-short">{stations === null ? 'Who is at work, and where somebody is needed.' : inShort(stations)}</p>
      </div>
      {/* The place is kept, so that nothing jumps when the line comes and goes. */}
      <div className={styles.line} data-line={line}>{said ? <Notice tone={said.tone} title={said.title}>{said.text}</Notice> : <p className={styles.muted}>The line stands: what is shown is less than a second old.</p>}</div>
      {stations === null ? <ul className={styles.wall} aria-busy="true">{Array.from({ length: 3 }, (_, i) => <li key={i} className={styles.tile}><Skeleton height="132px" /></li>)}</ul>
        : stations.length === 0 ? <p>No station is enrolled yet. {role === 'admin' || role === 'technician' ? <Link href="/network/stations">Enrol the first one.</Link> : 'A technician enrols them.'}</p>
          : <ul className={styles.wall} data-stale={line !== 'open' || undefined}>{inOrder(stations).map((one) => <Tile key={one.id} station={one} named={role === 'admin' || role === 'technician'} onStop={() => setStopping(one)} />)}</ul>}
      {stopping ? (
        <ReasonDialog title={`Stop ${stopping.name}`} deed="Stop it now" reasonNeeded text="The device goes to zero force at once and the trial ends; it is kept and marked as stopped. A person at the station lets it go on." onClose={() => setStopping(null)}
          onDeed={(reason) => stopStation(stopping.id, reason)} />
      ) : null}
    </div>
  );
}
