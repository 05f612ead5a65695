import { useMutation, useQueryClient } from '@tanstack/react-query';
import { useEffect, useRef, useState, type FormEvent } from 'react';
import { ApiError, sessionQuery, signIn } from '@/api';
import { Button, Field, useTitle } from '@/ui';
import { endedByItself } from './ended';
import styles from './sign-in.module.css';

function sentence(reason: Error): string {
  if (!(reason instanceof ApiError)) return 'Signing in failed.';
  switch (reason.code) {
    case 'unauthorised': return 'Name or password is wrong.';
    case 'too_many': return 'Too many failed attempts. Wait 15 minutes and try again.';
    default: return reason.message;
  }
}

export function SignIn() {
  useTitle('Sign in');
  const client = useQueryClient();
  const [name, setName] = useState('');
  const [password, setPassword] = useState('');
  const [ended] = useState(endedByItself);
  const nameField = useRef<HTMLInputElement>(null);
  const passwordField = useRef<HTMLInputElement>(null);
  const attempt = useMutation({
    mutationFn: () => signIn(name.trim(), password),
    onSuccess: (session) => client.setQueryData(sessionQuery.queryKey, session),
    onError: () => { setPassword(''); passwordField.current?.focus(); },
  });

  useEffect(() => nameField.current?.focus(), []);

  const submit = (event: FormEvent) => {
    event.preventDefault();
    if (name.trim() === '') nameField.current?.focus();
    else if (password === '') passwordField.current?.focus();
    else if (!attempt.isPending) attempt.mutate();
  };

  return (
    <div className={styles.place}>
      <form className={styles.form} onSubmit={submit} noValidate aria-labelledby="sign-in-title">
        <h1 id="sign-in-title">Sign in</h1>
        <p className={styles.lead}>
          {ended ? 'Your session has ended. Sign in to go on where you were.' : 'Trials of palpating pedicle screw tracts, and their assessment.'}
        </p>
        <Field label="Name" name="username" autoComplete="username" autoCapitalize="none" spellCheck={false} required
          inputRef={nameField} value={name} onChange={(event) => setName(event.target.value)} aria-invalid={attempt.isError} />
        <Field label="Password" name="password" type="password" autoComplete="current-password" required
          inputRef={passwordField} value={password} onChange={(event) => setPassword(event.target.value)} aria-invalid={attempt.isError} />
        <p className={styles.error} role="alert">{attempt.isError ? sentence(attempt.error) : ''}</p>
        <Button type="submit" look="solid" disabled={attempt.isPending}>{attempt.isPending ? 'Signing in…' : 'Sign in'}</Button>
      </form>
    </div>
  );
}
