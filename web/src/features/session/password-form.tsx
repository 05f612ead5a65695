import { useMutation, useQueryClient } from '@tanstack/react-query';
import { useState, type FormEvent } from 'react';
import { ApiError, changePassword, sessionQuery } from '@/api';
import { say } from '@/language';
import { Button, Field, Notice } from '@/ui';
import styles from './own-account.module.css';

const kLeast = 12;

/** The old password and a new one, twice; a one-time code once the server asks for it. */
export function PasswordForm() {
  const client = useQueryClient();
  const [old, setOld] = useState('');
  const [next, setNext] = useState('');
  const [again, setAgain] = useState('');
  const [code, setCode] = useState('');
  const [codeRequired, setCodeRequired] = useState(false);
  const changed = useMutation({
    mutationFn: () => changePassword(old, next, codeRequired ? code.trim() : undefined),
    onError: (reason) => {
      if (reason instanceof ApiError && reason.code === 'code_needed') setCodeRequired(true);
    },
    onSuccess: async () => {
      setOld('');
      setNext('');
      setAgain('');
      setCode('');
      await client.invalidateQueries({ queryKey: sessionQuery.queryKey });
    },
  });
  const fault =
    next !== '' && next.length < kLeast
      ? say('At least {least} characters.', { least: kLeast })
      : again !== '' && again !== next
        ? say('The passwords do not match.')
        : '';
  const submit = (event: FormEvent) => {
    event.preventDefault();
    changed.mutate();
  };
  return (
    <form className={styles.form} onSubmit={submit}>
      <Field
        label={say('Current password')}
        type="password"
        autoComplete="current-password"
        required
        value={old}
        onChange={(event) => setOld(event.target.value)}
      />
      <Field
        label={say('New password')}
        type="password"
        autoComplete="new-password"
        required
        value={next}
        onChange={(event) => setNext(event.target.value)}
      />
      <Field
        label={say('Repeat new password')}
        type="password"
        autoComplete="new-password"
        required
        value={again}
        onChange={(event) => setAgain(event.target.value)}
      />
      {codeRequired ? (
        <Field
          label={say('One-time code')}
          inputMode="numeric"
          autoComplete="one-time-code"
          maxLength={8}
          required
          value={code}
          onChange={(event) => setCode(event.target.value)}
        />
      ) : null}
      <p className={styles.fault} role="status">
        {fault}
      </p>
      {changed.error instanceof ApiError && changed.error.code === 'code_needed' ? (
        <Notice title={say('This account requires a one-time code.')}>
          {say('Enter the code that your app shows, then press “Change password” again.')}
        </Notice>
      ) : changed.isError ? (
        <Notice tone="bad" title={say('The password was not changed.')}>
          {changed.error.message}
        </Notice>
      ) : null}
      {changed.isSuccess ? (
        <Notice title={say('The password was changed.')}>{say('Other sessions of this account have ended.')}</Notice>
      ) : null}
      <Button
        look="solid"
        type="submit"
        disabled={changed.isPending || old === '' || next.length < kLeast || again !== next}
      >
        {changed.isPending ? say('Changing…') : say('Change password')}
      </Button>
    </form>
  );
}
