import { useMutation, useQueryClient } from '@tanstack/react-query';
import { useState, type FormEvent } from 'react';
import { Link } from 'wouter';
import { beginCodes, confirmCodes, endCodes, ownDataAddress } from '@/api';
import { kLanguageNames, kLanguages, language, readLanguage, say, type Language } from '@/language';
import { Button, Card, Field, Notice, Select, useTitle } from '@/ui';
import { chooseOwnLanguage } from './account-language';
import styles from './own-account.module.css';
import { PasswordForm } from './password-form';

function Codes() {
  const enrolled = useMutation({ mutationFn: () => beginCodes(password), onSuccess: () => setPassword('') });
  const confirmed = useMutation({ mutationFn: confirmCodes });
  const ended = useMutation({ mutationFn: () => endCodes(password, code.trim()) });
  const [password, setPassword] = useState('');
  const [code, setCode] = useState('');
  const submit = (event: FormEvent) => {
    event.preventDefault();
    confirmed.mutate(code.trim());
  };
  const failed = enrolled.error ?? confirmed.error ?? ended.error;
  const field = (
    <Field
      label={say('Code from the app')}
      value={code}
      inputMode="numeric"
      autoComplete="one-time-code"
      maxLength={8}
      onChange={(event) => setCode(event.target.value)}
    />
  );
  return (
    <div className={styles.stack}>
      <p>
        {say(
          'With one-time codes, a stolen password is not enough to sign in: an app on your phone shows a new code every 30 seconds.',
        )}
      </p>
      {failed ? (
        <Notice tone="bad" title={say('The action failed.')}>
          {failed.message}
        </Notice>
      ) : null}
      {confirmed.isSuccess ? (
        <Notice title={say('One-time codes are on.')}>{say('You will be asked for a code at each sign-in.')}</Notice>
      ) : ended.isSuccess ? (
        <Notice title={say('One-time codes are off.')}>{say('You sign in with your password only.')}</Notice>
      ) : enrolled.data ? (
        <form className={styles.form} onSubmit={submit}>
          <p>{say('Enter this secret in the app, then enter the code that the app shows.')}</p>
          <p className={styles.secret}>{enrolled.data.secret}</p>
          <p>
            <a href={enrolled.data.uri}>{say('Open in an app on this computer')}</a>
          </p>
          {field}
          <Button look="solid" type="submit" disabled={confirmed.isPending || code.trim() === ''}>
            {say('Turn on')}
          </Button>
        </form>
      ) : (
        <form
          className={styles.form}
          onSubmit={(event) => {
            event.preventDefault();
            if (code.trim() !== '') ended.mutate();
            else enrolled.mutate();
          }}
        >
          <Field
            label={say('Your password')}
            type="password"
            autoComplete="current-password"
            required
            value={password}
            onChange={(event) => setPassword(event.target.value)}
          />
          <Button onClick={() => enrolled.mutate()} disabled={enrolled.isPending || password === ''}>
            {say('Set up one-time codes')}
          </Button>
          <details>
            <summary>{say('Turn off one-time codes')}</summary>
            {field}
            <p>
              <Button type="submit" disabled={ended.isPending || password === '' || code.trim() === ''}>
                {say('Turn off')}
              </Button>
            </p>
          </details>
        </form>
      )}
    </div>
  );
}

function OwnLanguage() {
  const client = useQueryClient();
  const chosen = useMutation({ mutationFn: (one: Language) => chooseOwnLanguage(client, one) });
  return (
    <div className={styles.stack}>
      <p>
        {say('The pages in any browser, the kiosk after you sign in there, and e-mails to you are in this language.')}
      </p>
      {chosen.isError ? (
        <Notice tone="bad" title={say('The action failed.')}>
          {chosen.error.message}
        </Notice>
      ) : null}
      <Select
        label={say('Language')}
        value={language()}
        options={kLanguages.map((one) => ({ value: one, text: kLanguageNames[one] }))}
        onChange={({ target }) => chosen.mutate(readLanguage(target.value) ?? 'en')}
      />
    </div>
  );
}

/** Language, password and one-time codes of the signed-in person. */
export function OwnAccountPage() {
  useTitle(say('My account'));
  return (
    <div className={styles.page}>
      <h1>{say('My account')}</h1>
      <nav aria-label={say('My account')} className={styles.ways}>
        <Link href="/account/tokens">{say('API tokens')}</Link>
        <Link href="/account/notifications">{say('Notifications')}</Link>
      </nav>
      <Card title={say('Language')}>
        <OwnLanguage />
      </Card>
      <Card title={say('Password')}>
        <PasswordForm />
      </Card>
      <Card title={say('One-time codes')}>
        <Codes />
      </Card>
      <Card title={say('My data')}>
        <div className={styles.stack}>
          <p>
            {say(
              'One zip file with what this server holds of you: account, consents, assignments, your trials with their recordings, scores, comments and ratings, certificates and sign-ins. Its README.txt says what each file is. Trials whose results are not released yet are not in it. The download is recorded in the audit trail.',
            )}
          </p>
          <p>
            <a href={ownDataAddress} download>
              {say('Download my data')}
            </a>
          </p>
          <p>
            {say(
              'To leave, ask an administrator: they can erase your account with your trials, or keep your trials without your name.',
            )}
          </p>
        </div>
      </Card>
    </div>
  );
}

/** Shown first when the password was created by somebody else. */
export function FirstPassword() {
  useTitle(say('Choose a new password'));
  return (
    <div className={styles.page}>
      <h1>{say('Choose a new password')}</h1>
      <p>{say('Another person created your password. Choose a new one that only you know.')}</p>
      <Card title={say('Password')}>
        <PasswordForm />
      </Card>
    </div>
  );
}
