import { useMutation, useQuery, useQueryClient } from '@tanstack/react-query';
import { useEffect, useRef, useState, type FormEvent } from 'react';
import { ApiError, kOidcStart, oidcOfferQuery, readCard, sessionQuery, signIn } from '@/api';
import { say } from '@/language';
import { Button, Field, useTitle } from '@/ui';
import { endedByItself } from './ended';
import styles from './sign-in.module.css';

function errorText(reason: Error): string {
  if (!(reason instanceof ApiError)) return say('Signing in failed.');
  switch (reason.code) {
    case 'unauthorised':
      return say('Name or password is wrong.');
    case 'code_needed':
      return say('This account requires a one-time code.');
    case 'too_many':
      return reason.retryAfter_s === null
        ? say('Too many failed attempts. Try again in a few minutes.')
        : say('Too many failed attempts. Try again in {seconds} s.', { seconds: reason.retryAfter_s });
    default:
      return reason.message;
  }
}

/** What the server's answer after the provider's, or after a learning platform's, says in the address. */
function providerMessage(): string {
  switch (new URLSearchParams(window.location.search).get('sign_in')) {
    case 'unknown':
      return say(
        'Your institution confirmed your identity, but no account on this server is linked with it. Ask an administrator of this server.',
      );
    case 'failed':
      return say('Sign-in through your institution failed. Try again.');
    case 'launch_unknown':
      return say(
        'Your learning platform says who you are, but no account on this server is linked with you. Ask an administrator of this server: the audit trail has your launch.',
      );
    case 'launch_window':
      return say(
        'The browser kept the launch apart from this server. Open the link of your learning platform in a new window.',
      );
    case 'launch_here':
      return say('This account is not opened from a learning platform. Sign in here.');
    case 'launch_assignment':
      return say(
        'The link of your learning platform names an assignment that does not exist here. Tell the person who made the link.',
      );
    case 'launch_failed':
      return say(
        'The launch from your learning platform was refused. Follow the link there again; if that fails too, ask an administrator.',
      );
    default:
      return '';
  }
}

/** Name and first password of a sign-in card whose code was scanned. */
const scannedCard = () => readCard(window.location.hash) ?? { name: '', password: '' };

export function SignIn() {
  useTitle(say('Sign in'));
  const client = useQueryClient();
  const [card] = useState(scannedCard);
  const [name, setName] = useState(card.name);
  const [password, setPassword] = useState(card.password);
  const [code, setCode] = useState('');
  const [codeRequired, setCodeRequired] = useState(false);
  const [ended] = useState(endedByItself);
  const [back] = useState(providerMessage);
  const offer = useQuery(oidcOfferQuery);
  const nameField = useRef<HTMLInputElement>(null);
  const passwordField = useRef<HTMLInputElement>(null);
  const codeField = useRef<HTMLInputElement>(null);
  const attempt = useMutation({
    mutationFn: () => signIn(name.trim(), password, codeRequired ? code.trim() : undefined),
    onSuccess: (session) => client.setQueryData(sessionQuery.queryKey, session),
    onError: (reason) => {
      if (reason instanceof ApiError && reason.code === 'code_needed') {
        setCodeRequired(true);
        return;
      }
      setCode('');
      setPassword('');
      passwordField.current?.focus();
    },
  });

  useEffect(() => nameField.current?.focus(), []);
  useEffect(() => {
    // The password of a card must not stay in the address, nor in the browser's history.
    if (readCard(window.location.hash)) window.history.replaceState(null, '', window.location.pathname);
  }, []);
  useEffect(() => {
    if (codeRequired) codeField.current?.focus();
  }, [codeRequired]);

  const submit = (event: FormEvent) => {
    event.preventDefault();
    if (name.trim() === '') nameField.current?.focus();
    else if (password === '') passwordField.current?.focus();
    else if (!attempt.isPending) attempt.mutate();
  };

  return (
    <div className={styles.place}>
      <form className={styles.form} onSubmit={submit} noValidate aria-labelledby="sign-in-title">
        <h1 id="sign-in-title">{say('Sign in')}</h1>
        <p className={styles.lead}>
          {ended
            ? say('Your session has ended. Sign in to continue where you were.')
            : say('Training and assessment in drilling and palpating the channel of a pedicle screw.')}
        </p>
        <Field
          label={say('Name')}
          name="username"
          autoComplete="username"
          autoCapitalize="none"
          spellCheck={false}
          required
          inputRef={nameField}
          value={name}
          onChange={(event) => setName(event.target.value)}
          aria-invalid={attempt.isError}
        />
        <Field
          label={say('Password')}
          name="password"
          type="password"
          autoComplete="current-password"
          required
          inputRef={passwordField}
          value={password}
          onChange={(event) => setPassword(event.target.value)}
          aria-invalid={attempt.isError}
        />
        {codeRequired ? (
          <Field
            label={say('One-time code')}
            name="code"
            inputMode="numeric"
            autoComplete="one-time-code"
            maxLength={8}
            inputRef={codeField}
            value={code}
            onChange={(event) => setCode(event.target.value)}
          />
        ) : null}
        <p className={styles.error} role="alert">
          {attempt.isError ? errorText(attempt.error) : back}
        </p>
        <Button type="submit" look="solid" disabled={attempt.isPending}>
          {attempt.isPending ? say('Signing in…') : say('Sign in')}
        </Button>
        {offer.data?.offered ? (
          <a className={styles.provider} href={kOidcStart}>
            {offer.data.label ?? say('Sign in with your institution')}
          </a>
        ) : null}
      </form>
    </div>
  );
}
