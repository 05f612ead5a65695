import { useMutation, useQuery, useQueryClient } from '@tanstack/react-query';
import { useState, type FormEvent } from 'react';
import {
  previewRetention,
  retentionQuery,
  sessionQuery,
  setRetention,
  type ErasureMode,
  type RetentionEffect,
  type RetentionRules,
  type RetentionVersion,
} from '@/api';
import { marked, say } from '@/language';
import { Button, Card, DataTable, Field, Notice, Select } from '@/ui';
import { formatCount, formatDateTime } from '@/units';
import { Frame } from './frame';
import styles from './network.module.css';

const kOff: RetentionRules = {
  inactive_years: null,
  inactive_mode: 'anonymise',
  sign_ins_months: null,
  notice_days: 30,
};

const sentenceOf = (rules: RetentionRules) =>
  [
    rules.inactive_years === null
      ? say('Trainees stay, however long they are inactive.')
      : say(
          rules.inactive_mode === 'erase'
            ? marked('Trainees without sign-in or trial for {years} years are erased.')
            : marked('Trainees without sign-in or trial for {years} years are anonymised.'),
          { years: formatCount(rules.inactive_years) },
        ),
    rules.sign_ins_months === null
      ? say('Records of sign-ins stay.')
      : say('Records of sign-ins older than {months} months are removed.', {
          months: formatCount(rules.sign_ins_months),
        }),
    say('Notice period: {days} days.', { days: formatCount(rules.notice_days) }),
  ].join(' ');

function Effect({ effect, on }: { readonly effect: RetentionEffect; readonly on: string }) {
  return (
    <>
      <p role="status">
        {say(on, { people: formatCount(effect.people.length), records: formatCount(effect.sign_ins) })}
      </p>
      <DataTable<RetentionEffect['people'][number]>
        caption={say('People on whom the rules act')}
        order={say('by name')}
        minWidth={560}
        rows={effect.people}
        keyOf={({ id }) => id}
        empty={say('Nobody.')}
        columns={[
          { name: marked('Name'), cell: (one) => one.name },
          { name: marked('Last active'), cell: (one) => formatDateTime(one.last_utc_us) },
          { name: marked('Acts not before'), cell: (one) => formatDateTime(one.acts_utc_us) },
          { name: marked('Notice'), cell: (one) => (one.noticed ? say('runs') : say('not yet')) },
        ]}
      />
    </>
  );
}

const numberOf = (text: string) => (text.trim() === '' ? null : Number(text));

function RulesForm({ now }: { readonly now: RetentionRules }) {
  const client = useQueryClient();
  const [years, setYears] = useState(now.inactive_years?.toString() ?? '');
  const [months, setMonths] = useState(now.sign_ins_months?.toString() ?? '');
  const [days, setDays] = useState(now.notice_days.toString());
  const [mode, setMode] = useState<ErasureMode>(now.inactive_mode);
  const [reason, setReason] = useState('');
  const rules = (): RetentionRules => ({
    inactive_years: numberOf(years),
    inactive_mode: mode,
    sign_ins_months: numberOf(months),
    notice_days: Number(days),
  });
  const shown = useMutation({ mutationFn: () => previewRetention(rules()) });
  const set = useMutation({
    mutationFn: () => setRetention(rules(), reason.trim()),
    onSuccess: (data) => client.setQueryData(retentionQuery.queryKey, data),
  });
  const failed = shown.error ?? set.error;
  const changed = (change: () => void) => {
    change();
    shown.reset();
  };
  const submit = (event: FormEvent) => {
    event.preventDefault();
    if (shown.data) set.mutate();
    else shown.mutate();
  };
  return (
    <form className={styles.stack} onSubmit={submit}>
      {failed ? (
        <Notice tone="bad" title={say('The action failed.')}>
          {failed.message}
        </Notice>
      ) : null}
      <div className={styles.form}>
        <Field
          label={say('Years of inactivity (empty: off)')}
          inputMode="numeric"
          value={years}
          onChange={(event) => changed(() => setYears(event.target.value))}
        />
        <Select
          label={say('Inactive trainees are')}
          value={mode}
          onChange={(event) => changed(() => setMode(event.target.value === 'erase' ? 'erase' : 'anonymise'))}
          options={[
            { value: 'anonymise', text: say('anonymised (trials stay)') },
            { value: 'erase', text: say('erased with their trials') },
          ]}
        />
        <Field
          label={say('Months of sign-in records (empty: off)')}
          inputMode="numeric"
          value={months}
          onChange={(event) => changed(() => setMonths(event.target.value))}
        />
        <Field
          label={say('Notice period in days (7 to 365)')}
          inputMode="numeric"
          value={days}
          onChange={(event) => changed(() => setDays(event.target.value))}
        />
      </div>
      {shown.data ? (
        <>
          <Effect
            effect={shown.data}
            on={marked('These rules would act on {people} people and {records} records of sign-ins.')}
          />
          <Field
            label={say('Reason of the change')}
            value={reason}
            maxLength={500}
            onChange={(event) => setReason(event.target.value)}
          />
        </>
      ) : null}
      <p>
        <Button
          look="solid"
          type="submit"
          disabled={shown.isPending || set.isPending || (shown.data !== undefined && reason.trim() === '')}
        >
          {shown.data ? say('Set these rules') : say('Show on whom they act')}
        </Button>
      </p>
    </form>
  );
}

/** How long people's data are kept: the director's rules, shown before they act. */
export function RetentionPage() {
  const query = useQuery(retentionQuery);
  const role = useQuery({ ...sessionQuery, enabled: false }).data?.role;
  const newest = query.data?.versions[0];
  return (
    <Frame
      at="retention"
      lead={say(
        'How long people’s data are kept. A rule acts on a person after its notice period; whoever signs in or does a trial meanwhile stays. No rule acts unless a director sets one.',
      )}
    >
      {query.isError ? (
        <Notice tone="bad" title={say('The rules could not be loaded.')} onRetry={() => void query.refetch()}>
          {query.error.message}
        </Notice>
      ) : null}
      {query.data ? (
        <Card title={say('Rules now')}>
          <div className={styles.stack}>
            <p>{newest ? sentenceOf(newest) : say('No rule was ever set: nothing is removed by itself.')}</p>
            {newest ? (
              <Effect
                effect={query.data.effect}
                on={marked('They act on {people} people and {records} records of sign-ins.')}
              />
            ) : null}
          </div>
        </Card>
      ) : null}
      {query.data && role === 'director' ? (
        <Card title={say('New rules')}>
          <RulesForm key={newest?.version ?? 0} now={newest ?? kOff} />
        </Card>
      ) : null}
      {newest ? (
        <Card title={say('Versions')}>
          <DataTable<RetentionVersion>
            caption={say('Versions of the rules')}
            order={say('newest first')}
            minWidth={640}
            rows={query.data?.versions}
            keyOf={({ version }) => String(version)}
            empty={say('None.')}
            columns={[
              { name: marked('Version'), cell: (one) => formatCount(one.version), number: true },
              {
                name: marked('Set'),
                cell: (one) =>
                  say('{time} by {name}', {
                    time: formatDateTime(one.made_utc_us),
                    name: one.made_by,
                  }),
              },
              { name: marked('Rules'), cell: sentenceOf },
              { name: marked('Reason'), cell: (one) => one.reason },
            ]}
          />
        </Card>
      ) : null}
    </Frame>
  );
}
