import { useMutation, useQueryClient } from '@tanstack/react-query';
import { useState, type FormEvent } from 'react';
import { ApiError, apiTokensQuery, makeApiToken } from '@/api';
import { say } from '@/language';
import { Button, Card, Field, Notice } from '@/ui';
import { dateText, endOfDay_utc_us } from './dates';
import styles from './tokens.module.css';

interface Offered {
  readonly scope: string;
  readonly meaning: string;
}

function Scopes({
  offered,
  chosen,
  onChange,
}: {
  readonly offered: readonly Offered[];
  readonly chosen: readonly string[];
  readonly onChange: (scopes: readonly string[]) => void;
}) {
  return (
    <fieldset className={styles.scopes}>
      <legend>{say('Scopes: what programs may do with the token')}</legend>
      {offered.map(({ scope, meaning }) => (
        <label key={scope}>
          <input
            type="checkbox"
            checked={chosen.includes(scope)}
            onChange={({ target }) =>
              onChange(target.checked ? [...chosen, scope] : chosen.filter((one) => one !== scope))
            }
          />
          <span>
            <code>{scope}</code> {say(meaning)}
          </span>
        </label>
      ))}
    </fieldset>
  );
}

/** Makes a token, and shows it once. */
export function NewToken({ offered }: { readonly offered: readonly Offered[] }) {
  const client = useQueryClient();
  const [name, setName] = useState('');
  const [scopes, setScopes] = useState<readonly string[]>([]);
  const [until, setUntil] = useState(() => dateText(90));
  const [password, setPassword] = useState('');
  const [code, setCode] = useState('');
  const made = useMutation({
    mutationFn: makeApiToken,
    onSuccess: async () => {
      setName('');
      setScopes([]);
      await client.invalidateQueries({ queryKey: apiTokensQuery.queryKey });
    },
    onSettled: () => {
      setPassword('');
      setCode('');
    },
  });
  const needsCode = made.error instanceof ApiError && made.error.code === 'code_needed';
  const submit = (event: FormEvent) => {
    event.preventDefault();
    const expires_utc_us = endOfDay_utc_us(until);
    made.mutate({
      name: name.trim(),
      scopes,
      expires_utc_us,
      password,
      ...(code.trim() === '' ? {} : { code: code.trim() }),
    });
  };
  return (
    <Card title={say('New token')}>
      <div className={styles.stack}>
        <form className={styles.form} onSubmit={submit}>
          <Field
            label={say('Name')}
            value={name}
            required
            maxLength={60}
            autoComplete="off"
            onChange={(event) => setName(event.target.value)}
          />
          <Field
            label={say('Valid until')}
            type="date"
            required
            value={until}
            min={dateText(0)}
            max={dateText(364)}
            onChange={(event) => setUntil(event.target.value)}
          />
          <Scopes offered={offered} chosen={scopes} onChange={setScopes} />
          <Field
            label={say('Your password')}
            type="password"
            autoComplete="current-password"
            required
            value={password}
            onChange={(event) => setPassword(event.target.value)}
          />
          <Field
            label={needsCode ? say('One-time code') : say('One-time code (if you use them)')}
            value={code}
            inputMode="numeric"
            autoComplete="one-time-code"
            maxLength={8}
            onChange={(event) => setCode(event.target.value)}
          />
          <Button
            look="solid"
            type="submit"
            disabled={made.isPending || name.trim() === '' || scopes.length === 0 || password === ''}
          >
            {made.isPending ? say('Making…') : say('Make token')}
          </Button>
        </form>
        {made.isError ? (
          <Notice tone="bad" title={say('The token was not made.')}>
            {made.error.message}
          </Notice>
        ) : null}
        {made.data ? (
          <Notice tone="warn" title={say('Token {name}', { name: made.data.entry.name })}>
            <p className={styles.secret} data-part="secret">
              {made.data.token}
            </p>
            <p>{say('Copy the token now: it is shown only once. Keep it like a password.')}</p>
          </Notice>
        ) : null}
      </div>
    </Card>
  );
}
