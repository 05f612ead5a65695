import { useMutation, useQuery, useQueryClient } from '@tanstack/react-query';
import { useState } from 'react';
import { Link } from 'wouter';
import {
  accountsAsked,
  accountsQuery,
  allAccountsQuery,
  kRoles,
  resetPassword,
  sessionQuery,
  setAccountRole,
  setAccountState,
  setBadge,
  useSavedViews,
  type Account,
  type Role,
} from '@/api';
import { marked, say } from '@/language';
import { AskDialog, Badge, Button, Card, Field, ListTable, Notice, useList, type ListFilter } from '@/ui';
import { formatDateTime } from '@/units';
import { Frame } from './frame';
import { NewAccountCard, Once } from './new-account';
import styles from './network.module.css';
import { roleName } from './labels';

type AccountAction =
  | { readonly kind: 'password' | 'badge'; readonly account: Account }
  | { readonly kind: 'role'; readonly account: Account; readonly to: Role };

function BadgeDialog({
  account,
  onDone,
  onClose,
}: {
  readonly account: Account;
  readonly onDone: () => Promise<unknown>;
  readonly onClose: () => void;
}) {
  const [badge, setText] = useState(account.badge ?? '');
  const [pin, setPin] = useState('');
  return (
    <AskDialog
      title={say('Badge and PIN of {name}', { name: account.name })}
      action={say('Save')}
      ready={badge !== '' || pin !== ''}
      onAction={() => setBadge(account.id, badge, pin).then(onDone)}
      onClose={onClose}
    >
      <p>{say('The trainee signs in at a station with the badge and PIN.')}</p>
      <Field
        label={say('Badge number')}
        value={badge}
        maxLength={64}
        onChange={(event) => setText(event.target.value)}
      />
      <Field
        label={say('New PIN')}
        value={pin}
        maxLength={12}
        inputMode="numeric"
        onChange={(event) => setPin(event.target.value)}
      />
    </AskDialog>
  );
}

const stateOf = ({ state, must_change }: Account) =>
  say(state === 'disabled' ? 'disabled' : must_change ? marked('first password not changed yet') : 'active');

const kFilters: readonly ListFilter[] = [
  { name: 'role', label: marked('Role'), choices: kRoles.map((value) => ({ value, text: roleName(value) })) },
  {
    name: 'state',
    label: marked('State'),
    choices: [
      { value: 'active', text: marked('active') },
      { value: 'disabled', text: marked('disabled') },
    ],
  },
];

/** Accounts and their roles. */
export function PeoplePage() {
  const client = useQueryClient();
  const list = useList(accountsAsked);
  const query = useQuery(accountsQuery(list.query));
  const views = useSavedViews('accounts');
  const own = useQuery({ ...sessionQuery, enabled: false }).data?.id;
  const [action, setAction] = useState<AccountAction | null>(null);
  const [password, setPassword] = useState<{ name: string; secret: string } | null>(null);
  const fresh = () => client.invalidateQueries({ queryKey: allAccountsQuery.queryKey });
  const role = useMutation({
    mutationFn: ({ id, to }: { id: string; to: Role }) => setAccountRole(id, to),
    onSuccess: fresh,
  });
  const state = useMutation({
    mutationFn: ({ id, state: now }: Account) => setAccountState(id, now === 'active' ? 'disabled' : 'active'),
    onSuccess: fresh,
  });
  const failed = role.error ?? state.error;
  return (
    <Frame at="people" lead={say('Accounts and their roles. Every change is recorded in the audit trail.')}>
      {query.isError ? (
        <Notice tone="bad" title={say('The accounts could not be loaded.')} onRetry={() => void query.refetch()}>
          {query.error.message}
        </Notice>
      ) : null}
      {failed ? (
        <Notice tone="bad" title={say('The action failed.')}>
          {failed.message}
        </Notice>
      ) : null}
      {password ? (
        <Once title={say('New password of {name}', { name: password.name })} secret={password.secret}>
          {say(
            'This password is shown only once. All sessions of the account have ended and its one-time codes are turned off.',
          )}
        </Once>
      ) : null}
      <p className={styles.ways}>
        <Link href="/class">{say('Import a class from a spreadsheet')}</Link>
        <Link href="/class/change">{say('Change many accounts at once')}</Link>
        <Link href="/network/tokens">{say('API tokens of all accounts')}</Link>
        <Link href="/network/mail">{say('Mail and webhooks')}</Link>
      </p>
      <NewAccountCard />
      <Card title={say('Accounts')}>
        <ListTable<Account>
          caption={say('Accounts')}
          list={list}
          page={query.data}
          views={views}
          usual="name"
          searchLabel={say('Find by name, badge or level')}
          filters={kFilters}
          minWidth={1040}
          rows={query.data?.accounts}
          keyOf={({ id }) => id}
          empty={say('No accounts yet.')}
          columns={[
            { name: marked('Name'), sort: 'name', cell: (one) => one.name },
            {
              name: marked('Role'),
              sort: 'role',
              cell: (one) => (
                <span className={styles.role}>
                  <select
                    aria-label={say('Role of {name}', { name: one.name })}
                    value={one.role}
                    onChange={(event) => {
                      const to = kRoles.find((known) => known === event.target.value);
                      if (to === 'admin' || (to && one.role === 'admin')) setAction({ kind: 'role', account: one, to });
                      else if (to) role.mutate({ id: one.id, to });
                    }}
                  >
                    {kRoles.map((known) => (
                      <option key={known} value={known}>
                        {say(roleName(known))}
                      </option>
                    ))}
                  </select>
                </span>
              ),
            },
            {
              name: marked('State'),
              cell: (one) =>
                one.state === 'disabled' ? (
                  <Badge tone="warn">{stateOf(one)}</Badge>
                ) : one.must_change ? (
                  <Badge>{stateOf(one)}</Badge>
                ) : (
                  <Badge tone="good">{stateOf(one)}</Badge>
                ),
            },
            {
              name: marked('Badge'),
              cell: (one) => `${one.badge ?? '–'}${one.has_pin ? `, ${say('PIN')}` : ''}`,
            },
            { name: marked('One-time codes'), cell: (one) => (one.has_codes ? say('on') : say('off')) },
            { name: marked('Created'), sort: 'made', falls: true, cell: (one) => formatDateTime(one.made_utc_us) },
            {
              name: <span className="hidden-visually">{say('Actions')}</span>,
              cell: (one) => (
                <span className={styles.buttons}>
                  <Button
                    label={say('Badge and PIN of {name}', { name: one.name })}
                    onClick={() => setAction({ kind: 'badge', account: one })}
                  >
                    {say('Badge…')}
                  </Button>
                  <Button
                    label={say('New password for {name}', { name: one.name })}
                    disabled={one.id === own}
                    onClick={() => setAction({ kind: 'password', account: one })}
                  >
                    {say('Password…')}
                  </Button>
                  <Button
                    label={
                      one.state === 'active'
                        ? say('Disable {name}', { name: one.name })
                        : say('Enable {name}', { name: one.name })
                    }
                    disabled={state.isPending}
                    onClick={() => state.mutate(one)}
                  >
                    {one.state === 'active' ? say('Disable') : say('Enable')}
                  </Button>
                  <Link
                    href={`/network/people/${encodeURIComponent(one.id)}/leaving`}
                    aria-label={say('Erase or anonymise {name}', { name: one.name })}
                  >
                    {say('Erase…')}
                  </Link>
                </span>
              ),
            },
          ]}
        />
      </Card>
      {action?.kind === 'badge' ? (
        <BadgeDialog account={action.account} onDone={fresh} onClose={() => setAction(null)} />
      ) : null}
      {action?.kind === 'role' ? (
        <AskDialog
          title={say('Change the role of {name} to “{role}”?', {
            name: action.account.name,
            role: say(roleName(action.to)),
          })}
          action={say('Change role')}
          onClose={() => setAction(null)}
          onAction={() => role.mutateAsync({ id: action.account.id, to: action.to })}
        >
          <p>
            {action.to === 'admin'
              ? say(
                  'An administrator sees and changes everything on this server: accounts, studies, trials and backups.',
                )
              : say('The person can no longer administrate this server.')}{' '}
            {say('All sessions of the account end.')}
          </p>
        </AskDialog>
      ) : null}
      {action?.kind === 'password' ? (
        <AskDialog
          title={say('New password for {name}', { name: action.account.name })}
          action={say('Create new password')}
          onClose={() => setAction(null)}
          onAction={() =>
            resetPassword(action.account.id).then(async ({ password: secret }) => {
              setPassword({ name: action.account.name, secret });
              await fresh();
            })
          }
        >
          <p>
            {say(
              'The old password becomes invalid, all sessions of the account end, and its one-time codes are turned off.',
            )}
          </p>
        </AskDialog>
      ) : null}
    </Frame>
  );
}
