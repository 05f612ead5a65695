import { useQuery } from '@tanstack/react-query';
import { useState } from 'react';
import { Link } from 'wouter';
import { sessionQuery, stopStation, type StationState } from '@/api';
import { Badge, Button, Notice, ReasonDialog, Skeleton, useTitle } from '@/ui';
import { formatDateTime, formatDuration, formatForce, formatLength, newton, metre, second } from '@/units';
import { useLive } from './use-live';
import styles from './live.module.css';
import { byUrgency, summaryOf, isAtWork, kStates } from './station-states';

function Trial({ trial }: { readonly trial: NonNullable<StationState['trial']> }) {
  return (
    <dl className={styles.facts}>
      <div>
        <dt>Person</dt>
        <dd>{trial.person ?? 'person in another cohort'}</dd>
      </div>
      {trial.case_title === null ? null : (
        <div>
          <dt>Case</dt>
          <dd>{trial.case_title}</dd>
        </div>
      )}
      <div>
        <dt>Time</dt>
        <dd className={styles.number}>{formatDuration(second(trial.t_s))}</dd>
      </div>
      {trial.force_N === null ? null : (
        <div>
          <dt>Force</dt>
          <dd className={styles.number}>{formatForce(newton(trial.force_N))}</dd>
        </div>
      )}
      {trial.depth_m === null ? null : (
        <div>
          <dt>Depth</dt>
          <dd className={styles.number}>{formatLength(metre(trial.depth_m))}</dd>
        </div>
      )}
      {trial.late_ticks > 0 ? (
        <div>
          <dt>Late ticks</dt>
          <dd className={styles.number}>{trial.late_ticks}</dd>
        </div>
      ) : null}
    </dl>
  );
}

function since(station: StationState): string {
  if (station.state === 'away')
    return station.last_seen_utc_us === null
      ? 'never connected'
      : `last contact ${formatDateTime(station.last_seen_utc_us)}`;
  return station.since_utc_us === null || station.since_utc_us === 0
    ? ''
    : `since ${formatDateTime(station.since_utc_us)}`;
}

function Tile({
  station,
  named,
  onStop,
}: {
  readonly station: StationState;
  readonly named: boolean;
  readonly onStop: () => void;
}) {
  const state = kStates[station.state];
  return (
    <li className={styles.tile} data-tone={state.tone} data-station={station.name}>
      <div className={styles.head}>
        <h2 className={styles.name}>
          {named ? <Link href={`/network/stations/${station.id}`}>{station.name}</Link> : station.name}
        </h2>
        <Badge tone={state.tone}>{state.name}</Badge>
      </div>
      <p className={styles.muted}>
        {since(station)} {station.simulated === true ? <Badge tone="warn">simulated device</Badge> : null}
      </p>
      {station.trial === null ? <p className={styles.means}>{state.description}</p> : <Trial trial={station.trial} />}
      {(station.waiting_trials ?? 0) > 0 ? (
        <p className={styles.muted}>Trials to upload: {station.waiting_trials}</p>
      ) : null}
      {station.self_test?.passed === false ? (
        <p>
          <Badge tone="bad">self-test failed</Badge>{' '}
          <span className={styles.muted}>{station.self_test.failed.join(', ')}</span>
        </p>
      ) : null}
      <div className={styles.actions}>
        {isAtWork(station) ? (
          <Button label={`Stop ${station.name}`} onClick={onStop}>
            Stop…
          </Button>
        ) : null}
      </div>
    </li>
  );
}

const kConnection = {
  connecting: {
    tone: 'info',
    title: 'Connecting to the server…',
    text: 'The stations appear when the connection is established.',
  },
  lost: {
    tone: 'warn',
    title: 'The connection to the server is lost. Reconnecting…',
    text: 'The last known state is shown below. The stations continue without the server.',
  },
} as const;

/** All stations, live. */
export function LivePage() {
  useTitle('Live stations');
  const { connection, stations } = useLive();
  const role = useQuery({ ...sessionQuery, enabled: false }).data?.role;
  const [stopping, setStopping] = useState<StationState | null>(null);
  const problem = connection === 'open' ? null : kConnection[connection];
  return (
    <div className={styles.page}>
      <div>
        <h1>Live stations</h1>
        <p className={styles.lead} role="status" data-part="summary">
          {stations === null ? 'Stations in use and stations that need attention.' : summaryOf(stations)}
        </p>
      </div>
      {/* The space stays, so that nothing jumps when the connection state changes. */}
      <div className={styles.connection} data-connection={connection}>
        {problem ? (
          <Notice tone={problem.tone} title={problem.title}>
            {problem.text}
          </Notice>
        ) : (
          <p className={styles.muted}>Live: updated within one second.</p>
        )}
      </div>
      {stations === null ? (
        <ul className={styles.tiles} aria-busy="true">
          {Array.from({ length: 3 }, (_, i) => (
            <li key={i} className={styles.tile}>
              <Skeleton height="132px" />
            </li>
          ))}
        </ul>
      ) : stations.length === 0 ? (
        <p>
          No stations are enrolled yet.{' '}
          {role === 'admin' || role === 'technician' ? (
            <Link href="/network/stations">Enrol the first one.</Link>
          ) : (
            'A technician enrols them.'
          )}
        </p>
      ) : (
        <ul className={styles.tiles} data-stale={connection !== 'open' || undefined}>
          {byUrgency(stations).map((one) => (
            <Tile
              key={one.id}
              station={one}
              named={role === 'admin' || role === 'technician'}
              onStop={() => setStopping(one)}
            />
          ))}
        </ul>
      )}
      {stopping ? (
        <ReasonDialog
          title={`Stop ${stopping.name}`}
          action="Stop now"
          reasonNeeded
          text="The device goes to zero force immediately and the trial ends. The trial is saved and marked as stopped. A person at the station must resume operation."
          onClose={() => setStopping(null)}
          onAction={(reason) => stopStation(stopping.id, reason)}
        />
      ) : null}
    </div>
  );
}
