import { useMutation, useQuery, useQueryClient } from '@tanstack/react-query';
import { useState, type FormEvent } from 'react';
import {
  addLtiPlatform,
  linkLtiPerson,
  ltiPlatformsQuery,
  removeLtiPlatform,
  type LtiPlatform,
  type LtiPlatforms,
} from '@/api';
import { marked, say } from '@/language';
import { AskDialog, Button, Card, DataTable, Facts, Field, Notice } from '@/ui';
import { formatDateTime } from '@/units';
import styles from './notifications.module.css';

const kEmpty = { issuer: '', client_id: '', deployments: '', authorization_url: '', token_url: '', keys_url: '' };
type Filled = typeof kEmpty;
const kFields: readonly { readonly key: keyof Filled; readonly label: string; readonly url?: true }[] = [
  { key: 'issuer', label: marked('Issuer') },
  { key: 'client_id', label: marked('Client id') },
  { key: 'deployments', label: marked('Deployment ids, separated by spaces') },
  { key: 'authorization_url', label: marked('Authorisation address (https)'), url: true },
  { key: 'token_url', label: marked('Token address (https)'), url: true },
  { key: 'keys_url', label: marked('Address of the public keys (https)'), url: true },
];

const useFresh = () => {
  const client = useQueryClient();
  return () => client.invalidateQueries({ queryKey: ltiPlatformsQuery.queryKey });
};

function NewPlatform() {
  const fresh = useFresh();
  const [filled, setFilled] = useState<Filled>(kEmpty);
  const [matchEmail, setMatchEmail] = useState(false);
  const added = useMutation({
    mutationFn: addLtiPlatform,
    onSuccess: async () => {
      setFilled(kEmpty);
      setMatchEmail(false);
      await fresh();
    },
  });
  const submit = (event: FormEvent) => {
    event.preventDefault();
    const deployments = filled.deployments.split(/\s+/).filter((one) => one !== '');
    added.mutate({ ...filled, deployments, match_email: matchEmail });
  };
  return (
    <form className={styles.form} onSubmit={submit}>
      {kFields.map(({ key, label, url }) => (
        <Field
          key={key}
          label={say(label)}
          type={url ? 'url' : 'text'}
          required
          value={filled[key]}
          onChange={({ target }) => setFilled({ ...filled, [key]: target.value })}
        />
      ))}
      <label>
        <input type="checkbox" checked={matchEmail} onChange={({ target }) => setMatchEmail(target.checked)} />{' '}
        {say('An e-mail address that the platform verified links the trainee who has it')}
      </label>
      <Button look="solid" type="submit" disabled={added.isPending}>
        {say('Register platform')}
      </Button>
      {added.isError ? (
        <Notice tone="bad" title={say('The platform was not registered.')}>
          {added.error.message}
        </Notice>
      ) : null}
    </form>
  );
}

function LinkPerson({ platform }: { readonly platform: LtiPlatform }) {
  const [account, setAccount] = useState('');
  const [subject, setSubject] = useState('');
  const linked = useMutation({ mutationFn: linkLtiPerson });
  const submit = (event: FormEvent) => {
    event.preventDefault();
    linked.mutate({ id: platform.id, account: account.trim(), subject: subject.trim() });
  };
  return (
    <form className={styles.form} onSubmit={submit}>
      <h3>{say('Link a person of {issuer}', { issuer: platform.issuer })}</h3>
      <Field label={say('Account')} required value={account} onChange={({ target }) => setAccount(target.value)} />
      <Field
        label={say('Identifier at the platform (sub)')}
        value={subject}
        onChange={({ target }) => setSubject(target.value)}
      />
      <p className={styles.muted}>
        {say('A refused launch leaves the identifier in the audit trail. An empty field removes the link.')}
      </p>
      <Button type="submit" disabled={linked.isPending || account.trim() === ''}>
        {say('Link')}
      </Button>
      <p role="status">{linked.isSuccess ? say('Saved.') : ''}</p>
      {linked.isError ? (
        <Notice tone="bad" title={say('The person was not linked.')}>
          {linked.error.message}
        </Notice>
      ) : null}
    </form>
  );
}

function PlatformTable({ platforms }: Pick<LtiPlatforms, 'platforms'>) {
  const fresh = useFresh();
  const [asked, setAsked] = useState<LtiPlatform | null>(null);
  const [linking, setLinking] = useState<LtiPlatform | null>(null);
  const removed = useMutation({ mutationFn: removeLtiPlatform, onSuccess: fresh });
  return (
    <>
      <DataTable<LtiPlatform>
        caption={say('Learning platforms')}
        order={say('by issuer')}
        minWidth={640}
        rows={platforms}
        keyOf={({ id }) => id}
        empty={say('There are no learning platforms.')}
        columns={[
          { name: marked('Issuer'), by: (one) => one.issuer, cell: (one) => one.issuer },
          { name: marked('Client id'), by: (one) => one.client_id, cell: (one) => one.client_id },
          { name: marked('Deployments'), cell: (one) => one.deployments.join(', ') },
          { name: marked('Added'), by: (one) => one.made_utc_us, cell: (one) => formatDateTime(one.made_utc_us) },
          {
            name: <span className="hidden-visually">{say('Actions')}</span>,
            cell: (one) => (
              <span className={styles.buttons}>
                <Button
                  label={say('Link a person of {issuer}', { issuer: one.issuer })}
                  onClick={() => setLinking(linking?.id === one.id ? null : one)}
                >
                  {say('Link a person')}
                </Button>
                <Button label={say('Remove {name}', { name: one.issuer })} onClick={() => setAsked(one)}>
                  {say('Remove')}
                </Button>
              </span>
            ),
          },
        ]}
      />
      {linking ? <LinkPerson key={linking.id} platform={linking} /> : null}
      {asked ? (
        <AskDialog
          title={say('Remove this learning platform?')}
          action={say('Remove')}
          onAction={() => removed.mutateAsync(asked.id)}
          onClose={() => setAsked(null)}
        >
          <p>
            {say('{issuer} launches no page any more. The links of its people and waiting scores go with it.', {
              issuer: asked.issuer,
            })}
          </p>
        </AskDialog>
      ) : null}
    </>
  );
}

/** Learning platforms: registered, linked with people, removed. */
export function PlatformsCard() {
  const query = useQuery(ltiPlatformsQuery);
  return (
    <Card title={say('Learning platforms')}>
      <div className={styles.stack}>
        <p className={styles.muted}>
          {say(
            'A registered platform (LTI 1.3) opens an assignment here for a linked person; its gradebook gets the score once the results are released. The custom parameter assignment names the assignment by its id. A launch gives nobody an account or a role.',
          )}
        </p>
        {query.isError ? (
          <Notice tone="bad" title={say('The platforms could not be loaded.')} onRetry={() => void query.refetch()}>
            {query.error.message}
          </Notice>
        ) : null}
        {query.data ? (
          <>
            <Facts
              facts={[
                { name: say('To enter at the platform: login'), value: query.data.login_url },
                { name: say('To enter at the platform: launch'), value: query.data.launch_url },
                { name: say('To enter at the platform: public keys'), value: query.data.keys_url },
              ]}
            />
            <PlatformTable platforms={query.data.platforms} />
            <NewPlatform />
          </>
        ) : null}
      </div>
    </Card>
  );
}
