import { useQuery } from '@tanstack/react-query';
import { useState } from 'react';
import { Link } from 'wouter';
import { sessionQuery, stopStation, type StationState } from '@/api';
import { marked, say } from '@/language';
import { Badge, Button, Notice, ReasonDialog, Skeleton, useTitle } from '@/ui';
import { formatCount, formatDateTime, formatDuration, formatForce, formatLength, newton, metre, second } from '@/units';
import { useLive } from './use-live';
import styles from './live.module.css';
import { byUrgency, summaryOf, isAtWork, kStates } from './station-states';

function Trial({ trial }: { readonly trial: NonNullable<StationState['trial']> }) {
  return (
    <dl className={styles.facts}>
      <div>
        <dt>{say('Person')}</dt>
        <dd>{trial.person ?? say('person in another cohort')}</dd>
      </div>
      {trial.case_title === null ? null : (
        <div>
          <dt>{say('Case')}</dt>
          <dd>{trial.case_title}</dd>
        </div>
      )}
      <div>
        <dt>{say('Time')}</dt>
        <dd className={styles.number}>{formatDuration(second(trial.t_s))}</dd>
      </div>
      {trial.force_N === null ? null : (
        <div>
          <dt>{say('Force')}</dt>
          <dd className={styles.number}>{formatForce(newton(trial.force_N))}</dd>
        </div>
      )}
      {trial.depth_m === null ? null : (
        <div>
          <dt>{say('Depth')}</dt>
          <dd className={styles.number}>{formatLength(metre(trial.depth_m))}</dd>
        </div>
      )}
      {trial.late_ticks > 0 ? (
        <div>
          <dt>{say('Late ticks')}</dt>
          <dd className={styles.number}>{trial.late_ticks}</dd>
        </div>
      ) : null}
    </dl>
  );
}

function since(station: StationState): string {
  if (station.state === 'away')
    return station.last_seen_utc_us === null
      ? say('never connected')
      : say('last contact {time}', { time: formatDateTime(station.last_seen_utc_us) });
  return station.since_utc_us === null || station.since_utc_us === 0
    ? ''
    : say('since {time}', { time: formatDateTime(station.since_utc_us) });
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
        <Badge tone={state.tone}>{say(state.name)}</Badge>
      </div>
      <p className={styles.muted}>
        {since(station)} {station.simulated === true ? <Badge tone="warn">{say('simulated device')}</Badge> : null}
      </p>
      {station.trial === null ? (
        <p className={styles.means}>{say(state.description)}</p>
      ) : (
        <Trial trial={station.trial} />
      )}
      {(station.waiting_trials ?? 0) > 0 ? (
        <p className={styles.muted}>
          {say('Trials to upload: {count}', { count: formatCount(station.waiting_trials ?? 0) })}
        </p>
      ) : null}
      {station.self_test?.passed === false ? (
        <p>
          <Badge tone="bad">{say('self-test failed')}</Badge>{' '}
          <span className={styles.muted}>{station.self_test.failed.join(', ')}</span>
        </p>
      ) : null}
      <div className={styles.actions}>
        {isAtWork(station) ? (
          <Button label={say('Stop {station}', { station: station.name })} onClick={onStop}>
            {say('Stop…')}
          </Button>
        ) : null}
      </div>
    </li>
  );
}

const kConnection = {
  connecting: {
    tone: 'info',
    title: marked('Connecting to the server…'),
    text: marked('The stations appear when the connection is established.'),
  },
  lost: {
    tone: 'warn',
    title: marked('The connection to the server is lost. Reconnecting…'),
    text: marked('The last known state is shown below. The stations continue without the server.'),
  },
} as const;

/** All stations, live. */
export function LivePage() {
  useTitle(say('Live stations'));
  const { connection, stations } = useLive();
  const role = useQuery({ ...sessionQuery, enabled: false }).data?.role;
  const [stopping, setStopping] = useState<StationState | null>(null);
  const problem = connection === 'open' ? null : kConnection[connection];
  return (
    <div className={styles.page}>
      <div>
        <h1>{say('Live stations')}</h1>
        <p className={styles.lead} role="status" data-part="summary">
          {stations === null ? say('Stations in use and stations that need attention.') : summaryOf(stations)}
        </p>
      </div>
      {/* The space stays, so that nothing jumps when the connection state changes. */}
      <div className={styles.connection} data-connection={connection}>
        {problem ? (
          <Notice tone={problem.tone} title={say(problem.title)}>
            {say(problem.text)}
          </Notice>
        ) : (
          <p className={styles.muted}>{say('Live: updated within one second.')}</p>
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
          {say('No stations are enrolled yet.')}{' '}
          {role === 'admin' || role === 'technician' ? (
            <Link href="/network/stations">{say('Enrol the first one.')}</Link>
          ) : (
            say('A technician enrols them.')
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
          title={say('Stop {station}', { station: stopping.name })}
          action={say('Stop now')}
          reasonNeeded
          text={say(
            'The device goes to zero force immediately and the trial ends. The trial is saved and marked as stopped. A person at the station must resume operation.',
          )}
          onClose={() => setStopping(null)}
          onAction={(reason) => stopStation(stopping.id, reason)}
        />
      ) : null}
    </div>
  );
}
