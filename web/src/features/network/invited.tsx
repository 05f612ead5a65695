import { useMutation } from '@tanstack/react-query';
import { withdrawInvitation, type Cohort } from '@/api';
import { marked, say } from '@/language';
import { Button, Notice, Table } from '@/ui';
import { formatDateTime } from '@/units';

type Invited = Cohort['invitations'][number];

/** Invitations into a cohort that have no answer yet. */
export function InvitedPeople({
  cohort,
  onChange,
}: {
  readonly cohort: Cohort;
  readonly onChange: (cohort: Cohort) => Promise<void>;
}) {
  const withdrawn = useMutation({
    mutationFn: (name: string) => withdrawInvitation(cohort.id, name),
    onSuccess: onChange,
  });
  if (cohort.invitations.length === 0) return null;
  return (
    <>
      {withdrawn.isError ? (
        <Notice tone="bad" title={say('The action failed.')}>
          {withdrawn.error.message}
        </Notice>
      ) : null}
      <Table<Invited>
        caption={say('Pending invitations')}
        rows={cohort.invitations}
        keyOf={({ name }) => name}
        empty=""
        columns={[
          { name: marked('Invited'), cell: (one) => one.name },
          { name: marked('Invited by'), cell: (one) => one.made_by },
          { name: marked('Sent'), cell: (one) => formatDateTime(one.made_utc_us) },
          {
            name: <span className="hidden-visually">{say('Actions')}</span>,
            cell: (one) => (
              <Button
                look="quiet"
                label={say('Withdraw the invitation: {name}', { name: one.name })}
                disabled={withdrawn.isPending}
                onClick={() => withdrawn.mutate(one.name)}
              >
                {say('Withdraw')}
              </Button>
            ),
          },
        ]}
      />
    </>
  );
}
