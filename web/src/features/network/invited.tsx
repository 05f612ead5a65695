import { useMutation } from '@tanstack/react-query';
import { withdrawInvitation, type Cohort } from '@/api';
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
        <Notice tone="bad" title="The action failed.">
          {withdrawn.error.message}
        </Notice>
      ) : null}
      <Table<Invited>
        caption="Pending invitations"
        rows={cohort.invitations}
        keyOf={({ name }) => name}
        empty=""
        columns={[
          { name: 'Invited', cell: (one) => one.name },
          { name: 'Invited by', cell: (one) => one.made_by },
          { name: 'Sent', cell: (one) => formatDateTime(one.made_utc_us) },
          {
            name: <span className="hidden-visually">Actions</span>,
            cell: (one) => (
              <Button
                look="quiet"
                label={`Withdraw the invitation: ${one.name}`}
                disabled={withdrawn.isPending}
                onClick={() => withdrawn.mutate(one.name)}
              >
                Withdraw
              </Button>
            ),
          },
        ]}
      />
    </>
  );
}
