import { useMutation, useQuery, useQueryClient } from '@tanstack/react-query';
import { useState } from 'react';
import {
  allAccountsQuery,
  changeAccounts,
  cohortsQuery,
  kRoles,
  sessionQuery,
  type Account,
  type AccountChanges,
  type Role,
} from '@/api';
import { marked, say } from '@/language';
import { AskDialog, Button, Card, DataTable, Field, Notice, roleName, Select } from '@/ui';
import { formatCount } from '@/units';
import { Badges } from './badges';
import { Cards } from './cards';
import styles from './class.module.css';
import { Frame } from './frame';

type What = 'level' | 'cohort' | 'role' | 'badges' | 'cards';
const kActions: readonly { readonly value: What; readonly text: string }[] = [
  { value: 'level', text: marked('Set level') },
  { value: 'cohort', text: marked('Add to a cohort') },
  { value: 'role', text: marked('Change role') },
  { value: 'badges', text: marked('Assign badges') },
  { value: 'cards', text: marked('Print new sign-in cards') },
];
const kStates: Readonly<Record<Account['state'], string>> = { active: marked('active'), disabled: marked('disabled') };

/** Asks for what is to be set of all chosen accounts. */
function Change({
  what,
  chosen,
  onChange,
  onClose,
}: {
  readonly what: 'level' | 'cohort' | 'role' | 'cards';
  readonly chosen: readonly Account[];
  readonly onChange: (changes: Omit<AccountChanges, 'accounts'>) => Promise<unknown>;
  readonly onClose: () => void;
}) {
  const cohorts = useQuery({ ...cohortsQuery, enabled: what === 'cohort' });
  const [value, setValue] = useState(what === 'role' ? 'trainee' : '');
  const count = chosen.length;
  const changes = (): Omit<AccountChanges, 'accounts'> => {
    switch (what) {
      case 'level':
        return { level: value.trim() };
      case 'cohort':
        return { cohort: value };
      case 'role':
        return { role: value as Role };
      case 'cards':
        return { new_passwords: true };
    }
  };
  return (
    <AskDialog
      title={say('{action}: {count, plural, one {# account} other {# accounts}}', {
        action: say(kActions.find((one) => one.value === what)?.text ?? ''),
        count,
      })}
      action={what === 'cards' ? say('Make new cards') : say('Change')}
      ready={what === 'cards' || what === 'level' || value !== ''}
      onAction={() => onChange(changes())}
      onClose={onClose}
    >
      {what === 'level' ? (
        <Field
          label={say('Level (empty: none)')}
          value={value}
          maxLength={64}
          onChange={(event) => setValue(event.target.value)}
        />
      ) : null}
      {what === 'cohort' ? (
        <Select
          label={say('Cohort')}
          value={value}
          onChange={(event) => setValue(event.target.value)}
          options={[
            { value: '', text: say('Choose a cohort') },
            ...(cohorts.data?.cohorts ?? []).map(({ id, name }) => ({ value: id, text: name })),
          ]}
        />
      ) : null}
      {what === 'role' ? (
        <>
          <Select
            label={say('Role')}
            value={value}
            onChange={(event) => setValue(event.target.value)}
            options={kRoles.map((role) => ({
              value: role,
              text: role === 'admin' ? say('administrator') : roleName(role),
            }))}
          />
          <p>
            {value === 'admin'
              ? say(
                  'All {count, plural, one {# account} other {# accounts}} will see and change everything on this server. All sessions of these accounts end.',
                  { count },
                )
              : say('The people can do only what the new role allows. All sessions of these accounts end.')}
          </p>
        </>
      ) : null}
      {what === 'cards' ? (
        <p>
          {say(
            'The present passwords of {count, plural, one {# account} other {# accounts}} become invalid, their sessions end, and their one-time codes are turned off. Each person chooses a new password with the card.',
            { count },
          )}
        </p>
      ) : null}
    </AskDialog>
  );
}

/** Many accounts chosen from the list, and changed at once: all or none. */
export function ChangePage() {
  const client = useQueryClient();
  const query = useQuery(allAccountsQuery);
  const own = useQuery({ ...sessionQuery, enabled: false }).data?.id;
  const [ids, setIds] = useState<ReadonlySet<string>>(new Set());
  const [what, setWhat] = useState<What | null>(null);
  const changed = useMutation({
    mutationFn: changeAccounts,
    onSuccess: () => client.invalidateQueries({ queryKey: allAccountsQuery.queryKey }),
  });
  const all = query.data?.accounts.filter(({ id }) => id !== own);
  const chosen = (all ?? []).filter(({ id }) => ids.has(id));
  const cards = changed.data?.accounts.filter(({ password }) => password !== null) ?? [];
  const toggle = (id: string) => {
    const next = new Set(ids);
    if (!next.delete(id)) next.add(id);
    setIds(next);
  };
  const choose = (rows: readonly Account[]) => setIds(new Set(rows.map(({ id }) => id)));
  return (
    <Frame
      at="/class/change"
      lead={say(
        'Role, level, cohort, badges or new sign-in cards for many accounts at once. All are changed, or none. Your own account is not in the list.',
      )}
    >
      {query.isError ? (
        <Notice tone="bad" title={say('The accounts could not be loaded.')} onRetry={() => void query.refetch()}>
          {query.error.message}
        </Notice>
      ) : null}
      {cards.length > 0 ? (
        <Cards
          cards={cards.map(({ account, password }) => ({
            name: account.name,
            password: password ?? '',
            badge: account.badge,
          }))}
        />
      ) : null}
      <div className={styles.screen}>
        <Card
          title={say('Accounts')}
          aside={
            <span role="status" className={styles.muted}>
              {say('{count} chosen', { count: formatCount(chosen.length) })}
            </span>
          }
        >
          <div className={styles.stack}>
            <div className={styles.buttons}>
              {kActions.map(({ value, text }) => (
                <Button key={value} disabled={chosen.length === 0} onClick={() => setWhat(value)}>
                  {say(text)}…
                </Button>
              ))}
              <Button look="quiet" onClick={() => choose((all ?? []).filter(({ role }) => role === 'trainee'))}>
                {say('Choose all trainees')}
              </Button>
              <Button look="quiet" disabled={chosen.length === 0} onClick={() => setIds(new Set())}>
                {say('Choose none')}
              </Button>
            </div>
            {changed.isSuccess ? (
              <p role="status">
                {say('{count, plural, one {# account was} other {# accounts were}} changed.', {
                  count: changed.data.accounts.length,
                })}
              </p>
            ) : null}
            <DataTable<Account>
              address=""
              caption={say('Accounts')}
              minWidth={560}
              rows={all}
              keyOf={({ id }) => id}
              empty={say('No other accounts yet.')}
              filter={{
                label: say('Filter by name, role, level or badge'),
                text: (one) => `${one.name} ${roleName(one.role)} ${one.level} ${one.badge ?? ''}`,
              }}
              columns={[
                {
                  name: marked('Name'),
                  by: (one) => one.name,
                  cell: (one) => (
                    <label className={styles.choice}>
                      <input type="checkbox" checked={ids.has(one.id)} onChange={() => toggle(one.id)} />
                      {one.name}
                    </label>
                  ),
                },
                { name: marked('Role'), by: (one) => roleName(one.role), cell: (one) => roleName(one.role) },
                { name: marked('Level'), by: (one) => one.level, cell: (one) => one.level || '–' },
                {
                  name: marked('Badge'),
                  by: (one) => one.badge,
                  cell: (one) => `${one.badge ?? '–'}${one.has_pin ? `, ${say('PIN')}` : ''}`,
                },
                { name: marked('State'), by: (one) => one.state, cell: (one) => say(kStates[one.state]) },
              ]}
            />
          </div>
        </Card>
      </div>
      {what === 'badges' ? (
        <Badges
          accounts={chosen}
          onSave={(accounts) => changed.mutateAsync({ accounts })}
          onClose={() => setWhat(null)}
        />
      ) : what !== null ? (
        <Change
          what={what}
          chosen={chosen}
          onChange={(changes) => changed.mutateAsync({ accounts: chosen.map(({ id }) => ({ id })), ...changes })}
          onClose={() => setWhat(null)}
        />
      ) : null}
    </Frame>
  );
}
