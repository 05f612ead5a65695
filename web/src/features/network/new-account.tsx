import { useMutation, useQueryClient } from '@tanstack/react-query';
import { useState, type FormEvent } from 'react';
import { allAccountsQuery, addAccount, kRoles, type Role } from '@/api';
import { say } from '@/language';
import { AskDialog, Button, Card, Field, Notice, Select } from '@/ui';
import styles from './network.module.css';
import { kRoleLabels } from './labels';

/** A secret that the server created: shown once, on no other page. */
export function Once({
  title,
  secret,
  children,
}: {
  readonly title: string;
  readonly secret: string;
  readonly children: string;
}) {
  return (
    <Notice tone="warn" title={title}>
      <p className={styles.secret} data-part="secret">
        {secret}
      </p>
      <p>{children}</p>
    </Notice>
  );
}

/** Makes one account; an administrator only after a question. */
export function NewAccountCard() {
  const client = useQueryClient();
  const [name, setName] = useState('');
  const [role, setRole] = useState<Role>('trainee');
  const [badge, setBadgeText] = useState('');
  const [pin, setPin] = useState('');
  const made = useMutation({
    mutationFn: addAccount,
    onSuccess: async () => {
      setName('');
      setBadgeText('');
      setPin('');
      await client.invalidateQueries({ queryKey: allAccountsQuery.queryKey });
    },
  });
  const [asking, setAsking] = useState(false);
  const create = () =>
    made.mutateAsync({ name: name.trim(), role, ...(badge === '' ? {} : { badge }), ...(pin === '' ? {} : { pin }) });
  const submit = (event: FormEvent) => {
    event.preventDefault();
    if (role === 'admin') setAsking(true);
    else create().catch(() => undefined); // shown below
  };
  return (
    <Card title={say('New account')}>
      <div className={styles.stack}>
        <form className={styles.form} onSubmit={submit}>
          <Field
            label={say('Name')}
            value={name}
            required
            maxLength={100}
            autoComplete="off"
            onChange={(event) => setName(event.target.value)}
          />
          <Select
            label={say('Role')}
            value={role}
            onChange={(event) => {
              const next = kRoles.find((one) => one === event.target.value);
              if (next) setRole(next);
            }}
            options={kRoles.map((one) => ({ value: one, text: say(kRoleLabels[one].name) }))}
          />
          <Field
            label={say('Badge number (optional)')}
            value={badge}
            maxLength={64}
            autoComplete="off"
            onChange={(event) => setBadgeText(event.target.value)}
          />
          <Field
            label={say('PIN for stations (optional)')}
            value={pin}
            maxLength={12}
            inputMode="numeric"
            autoComplete="off"
            onChange={(event) => setPin(event.target.value)}
          />
          <p className={`${styles.wide} ${styles.muted}`}>{say(kRoleLabels[role].description)}</p>
          <Button look="solid" type="submit" disabled={made.isPending || name.trim() === ''}>
            {made.isPending ? say('Creating…') : say('Create account')}
          </Button>
        </form>
        {asking ? (
          <AskDialog
            title={say('Make {name} an administrator?', { name: name.trim() })}
            action={say('Create administrator')}
            onClose={() => setAsking(false)}
            onAction={create}
          >
            <p>
              {say(
                'An administrator sees and changes everything on this server: accounts, studies, trials and backups.',
              )}
            </p>
          </AskDialog>
        ) : null}
        {made.isError && !asking ? (
          <Notice tone="bad" title={say('The account was not created.')}>
            {made.error.message}
          </Notice>
        ) : null}
        {made.data?.password ? (
          <Once title={say('First password of {name}', { name: made.data.account.name })} secret={made.data.password}>
            {say('This password is shown only once. It must be changed at the first sign-in.')}
          </Once>
        ) : null}
      </div>
    </Card>
  );
}
