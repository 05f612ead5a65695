import { useMutation } from '@tanstack/react-query';
import { useState, type FormEvent } from 'react';
import { beginCodes, confirmCodes, endCodes } from '@/api';
import { Button, Card, Field, Notice, useTitle } from '@/ui';
import styles from './own-account.module.css';
import { PasswordForm } from './password-form';

function Codes() {
  const begun = useMutation({ mutationFn: () => beginCodes(password), onSuccess: () => setPassword('') });
  const confirmed = useMutation({ mutationFn: confirmCodes });
  const ended = useMutation({ mutationFn: () => endCodes(password, code.trim()) });
  const [password, setPassword] = useState('');
  const [code, setCode] = useState('');
  const submit = (event: FormEvent) => { event.preventDefault(); confirmed.mutate(code.trim()); };
  const failed = begun.error ?? confirmed.error ?? ended.error;
  const field = <Field label="Code from the app" value={code} inputMode="numeric" autoComplete="one-time-code" maxLength={8} onChange={(event) => setCode(event.target.value)} />;
  return (
    <div className={styles.stack}>
      <p>With one-time codes a stolen password alone lets nobody in: an app on your telephone makes a new code every half minute.</p>
      {failed ? <Notice tone="bad" title="That was not done.">{failed.message}</Notice> : null}
      {confirmed.isSuccess ? <Notice title="One-time codes are on.">From now on the sign-in asks for one.</Notice>
        : ended.isSuccess ? <Notice title="One-time codes are off.">The password alone lets you in.</Notice> : begun.data ? (
          <form className={styles.form} onSubmit={submit}>
            <p>Give this secret to the app, then write the code that it shows.</p>
            <p className={styles.secret}>{begun.data.secret}</p>
            <p><a href={begun.data.uri}>Open in an app on this machine</a></p>
            {field}
            <Button look="solid" type="submit" disabled={confirmed.isPending || code.trim() === ''}>Turn on</Button>
          </form>
        ) : (
          <form className={styles.form} onSubmit={(event) => { event.preventDefault(); if (code.trim() !== '') ended.mutate(); else begun.mutate(); }}>
            <Field label="Your password" type="password" autoComplete="current-password" required value={password} onChange={(event) => setPassword(event.target.value)} />
            <Button onClick={() => begun.mutate()} disabled={begun.isPending || password === ''}>Set up one-time codes</Button>
            <details><summary>They are on, and I want them off</summary>{field}<p><Button type="submit" disabled={ended.isPending || password === '' || code.trim() === ''}>Turn off</Button></p></details>
          </form>
        )}
    </div>
  );
}

/** The own password and one-time codes. */
export function OwnAccountPage() {
  useTitle('My account');
  return <div className={styles.page}><h1>My account</h1><Card title="Password"><PasswordForm /></Card><Card title="One-time codes"><Codes /></Card></div>;
}

/** Before anything else: the password was made by another. */
export function FirstPassword() {
  useTitle('A password of your own');
  return <div className={styles.page}><h1>A password of your own</h1><p>Your password was made for you. Choose one that only you know; then everything opens.</p><Card title="Password"><PasswordForm /></Card></div>;
}
