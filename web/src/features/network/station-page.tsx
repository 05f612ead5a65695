import { useMutation, useQuery, useQueryClient } from '@tanstack/react-query';
import { useState, type FormEvent } from 'react';
import { Link } from 'wouter';
import { limitStation, revokeStation, stationQuery, stationsQuery, type StationPage as Page } from '@/api';
import { marked, say } from '@/language';
import { AskDialog, Badge, Button, Card, Facts, Field, Notice, Skeleton, Table, Term, useTitle } from '@/ui';
import { formatBytes, formatDateTime, formatFound, formatShare, share } from '@/units';
import styles from './network.module.css';
import { calibrationLabel } from './labels';

type Test = Page['self_tests'][number];
type Check = Test['checks'][number];

const kStates: Readonly<Record<Page['state'], string>> = {
  away: marked('Offline'),
  idle: marked('Available'),
  preparing: marked('Preparing'),
  trial: marked('In a trial'),
  questions: marked('Answering'),
  stopped: marked('Stopped'),
  fault: marked('Fault'),
};
const kUnknown = marked('not reported yet');

function Health({ station, now }: { readonly station: Page; readonly now: number }) {
  const calibration = calibrationLabel(station.calibration_due_utc_us, now);
  return (
    <Card title={say('Status')}>
      <Facts
        facts={[
          {
            name: say('State'),
            value: station.connected ? (
              <Badge tone={station.state === 'fault' ? 'bad' : 'good'}>{say(kStates[station.state])}</Badge>
            ) : (
              <Badge>{say('offline')}</Badge>
            ),
          },
          {
            name: say('Last contact'),
            value: station.last_seen_utc_us === null ? say(kUnknown) : formatDateTime(station.last_seen_utc_us),
          },
          {
            name: say('Device'),
            value:
              station.device === null ? (
                say(kUnknown)
              ) : (
                <span>
                  {station.device} {station.simulated === true ? <Badge tone="warn">{say('simulated')}</Badge> : null}
                </span>
              ),
          },
          { name: say('Version'), value: station.version ?? say(kUnknown) },
          { name: say('Calibration'), value: <Badge tone={calibration.tone}>{calibration.text}</Badge> },
          {
            name: say('Self-test'),
            value:
              station.self_test === null ? (
                say(kUnknown)
              ) : station.self_test.passed ? (
                <Badge tone="good">{say('passed {time}', { time: formatDateTime(station.self_test.at_utc_us) })}</Badge>
              ) : (
                <Badge tone="bad">{say('failed: {checks}', { checks: station.self_test.failed.join(', ') })}</Badge>
              ),
          },
          {
            name: say('Free disk space'),
            value: station.free_disk_bytes === null ? say(kUnknown) : formatBytes(station.free_disk_bytes),
          },
          {
            name: say('Trials to upload'),
            value: station.waiting_trials === null ? say(kUnknown) : String(station.waiting_trials),
          },
          {
            name: (
              <Term
                definition={say(
                  'Ticks of the force loop that started late, as a share of all ticks in the last trials. Above 0.1 %, other programs use too much of the computer.',
                )}
              >
                {say('Late ticks')}
              </Term>
            ),
            value: station.late_share === null ? say(kUnknown) : formatShare(share(station.late_share), 2),
          },
          {
            name: (
              <Term
                definition={say(
                  'Difference between the clocks of the station and the server. Times within a trial do not depend on it.',
                )}
              >
                {say('Clock')}
              </Term>
            ),
            value: station.clock_offset_s === null ? say(kUnknown) : formatFound(station.clock_offset_s, 's'),
          },
        ]}
      />
    </Card>
  );
}

function Tests({ station }: { readonly station: Page }) {
  const [newest] = station.self_tests;
  return (
    <Card
      title={say('Self-test')}
      aside={newest ? <span className={styles.muted}>{formatDateTime(newest.at_utc_us)}</span> : null}
    >
      <div className={styles.stack}>
        <Table<Check>
          caption={say('Checks of the newest self-test')}
          rows={newest?.checks ?? []}
          keyOf={({ name }) => name}
          empty={say('No self-test reported yet. At the station, run: tractus-station self-test')}
          columns={[
            { name: marked('Check'), cell: (one) => one.name },
            { name: marked('Measured'), cell: (one) => formatFound(one.value, one.unit), number: true },
            { name: marked('Limit'), cell: (one) => formatFound(one.limit, one.unit), number: true },
            {
              name: marked('Result'),
              cell: (one) => (
                <Badge tone={one.passed ? 'good' : 'bad'}>{one.passed ? say('passed') : say('failed')}</Badge>
              ),
            },
            { name: marked('Details'), cell: (one) => <span className={styles.muted}>{one.words}</span> },
          ]}
        />
        {station.self_tests.length > 1 ? (
          <p className={styles.muted}>
            {say('Earlier: {tests}', {
              tests: station.self_tests
                .slice(1, 6)
                .map((one: Test) => `${formatDateTime(one.at_utc_us)} ${one.passed ? say('passed') : say('failed')}`)
                .join(' · '),
            })}
          </p>
        ) : null}
      </div>
    </Card>
  );
}

function Limit({ station }: { readonly station: Page }) {
  const [force, setForce] = useState('');
  const sent = useMutation({ mutationFn: () => limitStation(station.id, Number(force)) });
  const fits = Number(force) > 0 && Number(force) <= 100;
  const submit = (event: FormEvent) => {
    event.preventDefault();
    if (fits) sent.mutate();
  };
  return (
    <Card title={say('Force limit')}>
      <div className={styles.stack}>
        <p className={styles.muted}>
          {say(
            'Lower the limit if you suspect a fault of the device. Only a person at the station can raise it again.',
          )}
        </p>
        <form className={styles.form} onSubmit={submit}>
          <Field
            label={say('Maximum force, N')}
            value={force}
            type="number"
            inputMode="decimal"
            min={0.1}
            max={100}
            step={0.1}
            required
            onChange={(event) => setForce(event.target.value)}
          />
          <Button type="submit" disabled={sent.isPending || !fits}>
            {sent.isPending ? say('Sending…') : say('Lower limit')}
          </Button>
        </form>
        {sent.isError ? (
          <Notice tone="bad" title={say('The limit was not lowered.')}>
            {sent.error.message}
          </Notice>
        ) : null}
        {sent.isSuccess ? <p role="status">{say('The new limit was sent to the station.')}</p> : null}
      </div>
    </Card>
  );
}

/** One station, for the technician. */
export function StationPage({ id }: { readonly id: string }) {
  const client = useQueryClient();
  const query = useQuery(stationQuery(id));
  const [ending, setEnding] = useState(false);
  const station = query.data,
    now = query.dataUpdatedAt * 1000;
  useTitle(station ? station.name : say('Station'));
  const back = (
    <p>
      <Link href="/network/stations">{say('← Stations')}</Link>
    </p>
  );
  if (query.isError)
    return (
      <div className={styles.page}>
        {back}
        <Notice tone="bad" title={say('The station could not be loaded.')} onRetry={() => void query.refetch()}>
          {query.error.message}
        </Notice>
      </div>
    );
  if (!station)
    return (
      <div className={styles.page}>
        {back}
        <Skeleton width="280px" height="36px" />
        <Skeleton height="260px" />
        <Skeleton height="200px" />
      </div>
    );
  const revoked = station.revoked_utc_us !== null;
  return (
    <div className={styles.page}>
      {back}
      <div>
        <h1>
          {station.name} {revoked ? <Badge tone="warn">{say('revoked')}</Badge> : null}
        </h1>
        <p className={styles.lead}>
          {station.revoked_utc_us === null
            ? say('Enrolled {time}', { time: formatDateTime(station.enrolled_utc_us) })
            : say('Enrolled {time}, revoked {end}', {
                time: formatDateTime(station.enrolled_utc_us),
                end: formatDateTime(station.revoked_utc_us),
              })}
        </p>
      </div>
      <Health station={station} now={now} />
      <Tests station={station} />
      <Card title={say('Calibrations')}>
        <Table<Page['calibrations'][number]>
          caption={say('Calibrations, newest first')}
          rows={station.calibrations}
          keyOf={(one) => String(one.at_utc_us)}
          empty={say('No calibration reported yet. At the station, run: tractus-station calibrate')}
          columns={[
            { name: marked('Date'), cell: (one) => formatDateTime(one.at_utc_us) },
            { name: marked('Type'), cell: (one) => one.kind },
            {
              name: marked('Due'),
              cell: (one) =>
                one.due_utc_us === null ? (
                  <span className={styles.muted}>{say('no date')}</span>
                ) : (
                  <Badge tone={calibrationLabel(one.due_utc_us, now).tone}>{formatDateTime(one.due_utc_us)}</Badge>
                ),
            },
            { name: marked('Result'), cell: (one) => <span className={styles.muted}>{one.words}</span> },
          ]}
        />
      </Card>
      {revoked ? null : <Limit station={station} />}
      {revoked ? null : (
        <Card title={say('Revoke access')}>
          <div className={styles.stack}>
            <p className={styles.muted}>
              {say('Use this for a station that is lost or given away. Its recordings stay on its disk.')}
            </p>
            <p>
              <Button onClick={() => setEnding(true)}>{say('Revoke {name}…', { name: station.name })}</Button>
            </p>
          </div>
        </Card>
      )}
      {ending ? (
        <AskDialog
          title={say('Revoke {name}', { name: station.name })}
          action={say('Revoke')}
          onClose={() => setEnding(false)}
          onAction={() =>
            revokeStation(station.id).then(() =>
              Promise.all([client.invalidateQueries({ queryKey: stationsQuery.queryKey }), query.refetch()]),
            )
          }
        >
          <p>
            {say(
              'The server refuses the key of this station from now on. This cannot be undone. To use the station again, enrol it again.',
            )}
          </p>
        </AskDialog>
      ) : null}
    </div>
  );
}
