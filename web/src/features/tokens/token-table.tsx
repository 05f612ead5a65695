import { useMutation, useQueryClient } from '@tanstack/react-query';
import { useState } from 'react';
import { revokeApiToken, type ApiToken } from '@/api';
import { marked, say } from '@/language';
import { AskDialog, Badge, Button, DataTable, Notice } from '@/ui';
import { formatDate, formatDateTime } from '@/units';

/** The clock of this computer, in the server's unit. */
const now_utc_us = () => Date.now() * 1000;

export function tokenState(token: ApiToken, now: number): { readonly text: string; readonly tone: 'good' | 'neutral' } {
  if (token.revoked_utc_us !== null)
    return {
      text: say('revoked {date} by {name}', { date: formatDate(token.revoked_utc_us), name: token.revoked_by ?? '' }),
      tone: 'neutral',
    };
  const date = formatDate(token.expires_utc_us);
  if (token.expires_utc_us <= now) return { text: say('expired {date}', { date }), tone: 'neutral' };
  return { text: say('valid until {date}', { date }), tone: 'good' };
}

/** Tokens with a button that revokes one. */
export function TokenTable({
  tokens,
  owners = false,
  empty,
}: {
  readonly tokens: readonly ApiToken[] | undefined;
  readonly owners?: boolean;
  readonly empty: string;
}) {
  const client = useQueryClient();
  const [asked, setAsked] = useState<ApiToken | null>(null);
  const revoked = useMutation({
    mutationFn: revokeApiToken,
    onSuccess: () => client.invalidateQueries({ queryKey: ['api-tokens'] }),
  });
  const now = now_utc_us();
  return (
    <>
      {revoked.isError ? (
        <Notice tone="bad" title={say('The token was not revoked.')}>
          {revoked.error.message}
        </Notice>
      ) : null}
      <DataTable<ApiToken>
        caption={say('API tokens')}
        order={owners ? say('by owner') : say('newest first')}
        minWidth={720}
        rows={tokens}
        keyOf={({ id }) => id}
        empty={empty}
        columns={[
          ...(owners
            ? [{ name: marked('Owner'), by: (one: ApiToken) => one.owner, cell: (one: ApiToken) => one.owner }]
            : []),
          { name: marked('Name'), by: (one) => one.name, cell: (one) => one.name },
          { name: marked('Scopes'), cell: (one) => one.scopes.join(', ') },
          {
            name: marked('State'),
            by: (one) => one.expires_utc_us,
            cell: (one) => {
              const { text, tone } = tokenState(one, now);
              return <Badge tone={tone}>{text}</Badge>;
            },
          },
          {
            name: marked('Last use'),
            by: (one) => one.used_utc_us,
            cell: (one) => (one.used_utc_us === null ? say('never') : formatDateTime(one.used_utc_us)),
          },
          {
            name: <span className="hidden-visually">{say('Actions')}</span>,
            cell: (one) =>
              tokenState(one, now).tone === 'good' ? (
                <Button label={say('Revoke {name}', { name: one.name })} onClick={() => setAsked(one)}>
                  {say('Revoke')}
                </Button>
              ) : null,
          },
        ]}
      />
      {asked ? (
        <AskDialog
          title={say('Revoke {name}?', { name: asked.name })}
          action={say('Revoke')}
          onAction={() => revoked.mutateAsync(asked.id)}
          onClose={() => setAsked(null)}
        >
          <p>
            {say('Programs that use this token can no longer call the server. A revoked token cannot be restored.')}
          </p>
        </AskDialog>
      ) : null}
    </>
  );
}
