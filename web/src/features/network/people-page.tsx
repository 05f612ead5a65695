import { useMutation, useQuery, useQueryClient } from '@tanstack/react-query';
import { useState, type FormEvent } from 'react';
import { accountsQuery, addAccount, kRoles, resetPassword, sessionQuery, setAccountRole, setAccountState, setBadge, type Account, type Role } from '@/api';
import { AskDialog, Badge, Button, Card, Field, Notice, Select, Table } from '@/ui';
import { formatDateTime } from '@/units';
import { Frame } from './frame';
import styles from './network.module.css';
import { kRoleWords, roleName } from './words';

/** A password that a machine made is shown once, and by no page again. */
export function Once({ title, secret, children }: { readonly title: string; readonly secret: string; readonly children: string }) {
  return <Notice tone="warn" title={title}><p className={styles.secret} data-part="secret">{secret}</p><p>{children}</p></Notice>;
}

function NewAccountCard() {
  const client = useQueryClient();
  const [name, setName] = useState('');
  const [role, setRole] = useState<Role>('trainee');
  const [badge, setBadgeText] = useState('');
  const [pin, setPin] = useState('');
  const made = useMutation({
    mutationFn: addAccount,
    onSuccess: async () => { setName(''); setBadgeText(''); setPin(''); await client.invalidateQueries({ queryKey: accountsQuery.queryKey }); },
  });
  const submit = (event: FormEvent) => {
    event.preventDefault();
    made.mutate({ name: name.trim(), role, ...(badge === '' ? {} : { badge }), ...(pin === '' ? {} : { pin }) });
  };
  return (
    <Card title="New account">
      <div className={styles.stack}>
        <form className={styles.form} onSubmit={submit}>
          <Field label="Name" value={name} required maxLength={100} autoComplete="off" onChange={(event) => setName(event.target.value)} />
          <Select label="Role" value={role} onChange={(event) => { const next = kRoles.find((one) => one === event.target.value); if (next) setRole(next); }} options={kRoles.map((one) => ({ value: one, text: kRoleWords[one].name }))} />
          <Field label="Badge number (may be left out)" value={badge} maxLength={64} autoComplete="off" onChange={(event) => setBadgeText(event.target.value)} />
          <Field label="PIN for stations (may be left out)" value={pin} maxLength={12} inputMode="numeric" autoComplete="off" onChange={(event) => setPin(event.target.value)} />
          <p className={`${styles.wide} ${styles.muted}`}>{kRoleWords[role].may}</p>
          <Button look="solid" type="submit" disabled={made.isPending || name.trim() === ''}>{made.isPending ? 'Making…' : 'Make the account'}</Button>
        </form>
        {made.isError ? <Notice tone="bad" title="The account was not made.">{made.error.message}</Notice> : null}
        {made.data?.password ? <Once title={`The first password of ${made.data.account.name}`} secret={made.data.password}>It is shown this once. It has to be changed at the first sign-in.</Once> : null}
      </div>
    </Card>
  );
}

type Deed = { readonly kind: 'password' | 'badge'; readonly account: Account };

function BadgeDialog({ account, onDone, onClose }: { readonly account: Account; readonly onDone: () => Promise<unknown>; readonly onClose: () => void }) {
  const [badge, setText] = useState(account.badge ?? '');
  const [pin, setPin] = useState('');
  return (
    <AskDialog title={`Badge and PIN of ${account.name}`} deed="Set" ready={badge !== '' || pin !== ''} onDeed={() => setBadge(account.id, badge, pin).then(onDone)} onClose={onClose}>
      <p>With these the trainee signs in at a station in seconds.</p>
      <Field label="Badge number" value={badge} maxLength={64} onChange={(event) => setText(event.target.value)} />
      <Field label="New PIN" value={pin} maxLength={12} inputMode="numeric" onChange={(event) => setPin(event.target.value)} />
    </AskDialog>
  );
}

/** Who may come in, and as what. */
export function PeoplePage() {
  const client = useQueryClient();
  const query = useQuery(accountsQuery);
  const own = useQuery({ ...sessionQuery, enabled: false }).data?.id;
  const [deed, setDeed] = useState<Deed | null>(null);
  const [password, setPassword] = useState<{ name: string; secret: string } | null>(null);
  const fresh = () => client.invalidateQueries({ queryKey: accountsQuery.queryKey });
  const role = useMutation({ mutationFn: ({ id, to }: { id: string; to: Role }) => setAccountRole(id, to), onSuccess: fresh });
  const state = useMutation({ mutationFn: ({ id, state: now }: Account) => setAccountState(id, now === 'active' ? 'disabled' : 'active'), onSuccess: fresh });
  const failed = role.error ?? state.error;
  return (
    <Frame at="people" lead="Who may come in, and as what. Every change is written into the audit trail.">
      {query.isError ? <Notice tone="bad" title="The accounts could not be loaded." onRetry={() => void query.refetch()}>{query.error.message}</Notice> : null}
      {failed ? <Notice tone="bad" title="That was not done.">{failed.message}</Notice> : null}
      {password ? <Once title={`New password of ${password.name}`} secret={password.secret}>It is shown this once. Sessions and one-time codes of the account have ended.</Once> : null}
      <NewAccountCard />
      <Card title="Accounts">
        <Table<Account> caption="Accounts" minWidth={860} rows={query.data?.accounts} keyOf={({ id }) => id} empty="There are no accounts yet." columns={[
          { name: 'Name', cell: (one) => one.name },
          { name: 'Role', cell: (one) => (
            <span className={styles.role}>
              <select aria-label={`Role of ${one.name}`} value={one.role} onChange={(event) => { const to = kRoles.find((known) => known === event.target.value); if (to) role.mutate({ id: one.id, to }); }}>
                {kRoles.map((known) => <option key={known} value={known}>{roleName(known)}</option>)}
              </select>
            </span>) },
          { name: 'State', cell: (one) => (one.state === 'disabled' ? <Badge tone="warn">disabled</Badge> : one.must_change ? <Badge>first password not changed yet</Badge> : <Badge tone="good">active</Badge>) },
          { name: 'Badge', cell: (one) => `${one.badge ?? '–'}${one.has_pin ? ', PIN' : ''}` },
          { name: 'One-time codes', cell: (one) => (one.has_codes ? 'on' : 'off') },
          { name: 'Made', cell: (one) => formatDateTime(one.made_utc_us) },
          { name: <span className="hidden-visually">Decide</span>, cell: (one) => (
            <span className={styles.buttons}>
              <Button label={`Badge and PIN of ${one.name}`} onClick={() => setDeed({ kind: 'badge', account: one })}>Badge…</Button>
              <Button label={`New password for ${one.name}`} disabled={one.id === own} onClick={() => setDeed({ kind: 'password', account: one })}>Password…</Button>
              <Button label={`${one.state === 'active' ? 'Disable' : 'Enable'} ${one.name}`} disabled={state.isPending} onClick={() => state.mutate(one)}>{one.state === 'active' ? 'Disable' : 'Enable'}</Button>
            </span>) },
        ]} />
      </Card>
      {deed?.kind === 'badge' ? <BadgeDialog account={deed.account} onDone={fresh} onClose={() => setDeed(null)} /> : null}
      {deed?.kind === 'password' ? (
        <AskDialog title={`New password for ${deed.account.name}`} deed="Make a new password" onClose={() => setDeed(null)}
          onDeed={() => resetPassword(deed.account.id).then(async ({ password: secret }) => { setPassword({ name: deed.account.name, secret }); await fresh(); })}>
          <p>The old one ends, with every session and the one-time codes of the account.</p>
        </AskDialog>
      ) : null}
    </Frame>
  );
}
