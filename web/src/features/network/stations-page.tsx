import { useMutation, useQuery, useQueryClient } from '@tanstack/react-query';
import { useState, type FormEvent } from 'react';
import { enrolStation, revokeStation, sessionQuery, stationsQuery, type Station } from '@/api';
import { Link } from 'wouter';
import { marked, say } from '@/language';
import { AskDialog, Badge, Button, Card, DataTable, Field, Notice } from '@/ui';
import { formatDateTime } from '@/units';
import { Frame } from './frame';
import styles from './network.module.css';
import { Once } from './new-account';
import { calibrationLabel } from './labels';

function Enrol() {
  const client = useQueryClient();
  const [name, setName] = useState('');
  const made = useMutation({
    mutationFn: enrolStation,
    onSuccess: () => client.invalidateQueries({ queryKey: stationsQuery.queryKey }),
  });
  const submit = (event: FormEvent) => {
    event.preventDefault();
    made.mutate(name.trim());
  };
  return (
    <Card title={say('Enrol a station')}>
      <div className={styles.stack}>
        <form className={styles.form} onSubmit={submit}>
          <Field
            label={say('Name of the station')}
            value={name}
            required
            maxLength={64}
            placeholder={say('skills lab 2')}
            onChange={(event) => setName(event.target.value)}
          />
          <Button look="solid" type="submit" disabled={made.isPending || name.trim() === ''}>
            {made.isPending ? say('Creating…') : say('Create code')}
          </Button>
        </form>
        {made.isError ? (
          <Notice tone="bad" title={say('The code was not created.')}>
            {made.error.message}
          </Notice>
        ) : null}
        {made.data ? (
          <Once
            title={say('Code for {name}, valid until {time}', {
              name: made.data.name,
              time: formatDateTime(made.data.expires_utc_us),
            })}
            secret={made.data.code}
          >
            {say('Enter this code at the station. It can be used once; the station uses it to register its own key.')}
          </Once>
        ) : null}
      </div>
    </Card>
  );
}

const kTones = { revoked: 'warn', offline: 'neutral', fault: 'bad', connected: 'good' } as const;

const kStates: Readonly<Record<keyof typeof kTones, string>> = {
  revoked: marked('revoked'),
  offline: marked('offline'),
  fault: marked('fault'),
  connected: marked('connected'),
};

function stateOf(station: Station): keyof typeof kTones {
  if (station.revoked_utc_us !== null) return 'revoked';
  if (!station.connected) return 'offline';
  return station.state === 'fault' ? 'fault' : 'connected';
}

function StateBadge({ station }: { readonly station: Station }) {
  const state = stateOf(station);
  return <Badge tone={kTones[state]}>{say(kStates[state])}</Badge>;
}

/** The enrolled stations. */
export function StationsPage() {
  const client = useQueryClient();
  const query = useQuery(stationsQuery);
  const role = useQuery({ ...sessionQuery, enabled: false }).data?.role;
  const [ending, setEnding] = useState<Station | null>(null);
  const may = role === 'admin' || role === 'technician';
  return (
    <Frame
      at="stations"
      lead={say(
        'Stations that may download cases and upload trials. A revoked station is refused immediately; its recordings stay on its disk.',
      )}
    >
      {query.isError ? (
        <Notice tone="bad" title={say('The stations could not be loaded.')} onRetry={() => void query.refetch()}>
          {query.error.message}
        </Notice>
      ) : null}
      <p>
        <Link href="/wall">{say('Live view')}</Link>
      </p>
      {may ? <Enrol /> : null}
      <Card title={say('Stations')}>
        <DataTable<Station>
          address=""
          caption={say('Stations')}
          minWidth={760}
          rows={query.data?.stations}
          keyOf={({ id }) => id}
          empty={say('No stations are enrolled yet.')}
          filter={{ label: say('Filter by name or state'), text: (one) => `${one.name} ${say(kStates[stateOf(one)])}` }}
          columns={[
            {
              name: marked('Station'),
              by: (one) => one.name,
              cell: (one) => (may ? <Link href={`/network/stations/${one.id}`}>{one.name}</Link> : one.name),
            },
            { name: marked('State'), by: stateOf, cell: (one) => <StateBadge station={one} /> },
            {
              name: marked('Last contact'),
              by: (one) => one.last_seen_utc_us,
              cell: (one) => (one.last_seen_utc_us === null ? say('never') : formatDateTime(one.last_seen_utc_us)),
            },
            {
              name: marked('Self-test'),
              by: (one) => one.self_test?.passed,
              cell: (one) =>
                one.self_test === null ? (
                  <span className={styles.muted}>{say('not reported yet')}</span>
                ) : (
                  <Badge tone={one.self_test.passed ? 'good' : 'bad'}>
                    {one.self_test.passed ? say('passed') : say('failed')}
                  </Badge>
                ),
            },
            {
              name: marked('Calibration'),
              by: (one) => one.calibration_due_utc_us,
              cell: (one) => {
                const due = calibrationLabel(one.calibration_due_utc_us, query.dataUpdatedAt * 1000);
                return <Badge tone={due.tone}>{due.text}</Badge>;
              },
            },
            {
              name: marked('Enrolled'),
              by: (one) => one.enrolled_utc_us,
              cell: (one) => formatDateTime(one.enrolled_utc_us),
            },
            {
              name: <span className="hidden-visually">{say('Actions')}</span>,
              cell: (one) =>
                may && one.revoked_utc_us === null ? (
                  <span className={styles.buttons}>
                    <Button label={say('Revoke {name}', { name: one.name })} onClick={() => setEnding(one)}>
                      {say('Revoke…')}
                    </Button>
                  </span>
                ) : null,
            },
          ]}
        />
      </Card>
      {ending ? (
        <AskDialog
          title={say('Revoke {name}', { name: ending.name })}
          action={say('Revoke')}
          onClose={() => setEnding(null)}
          onAction={() =>
            revokeStation(ending.id).then(() => client.invalidateQueries({ queryKey: stationsQuery.queryKey }))
          }
        >
          <p>
            {say(
              'The server refuses the key of this station from now on. This cannot be undone. To use the station again, enrol it again.',
            )}
          </p>
        </AskDialog>
      ) : null}
    </Frame>
  );
}
