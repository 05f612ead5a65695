import { useMutation } from '@tanstack/react-query';
import { withdrawInvitation, type Cohort } from '@/api';
import { Button, Notice, Table } from '@/ui';
import { formatDateTime } from '@/units';

type Invited = Cohort['invitations'][number];

/** Who was asked into a cohort and has not answered. */
export function InvitedPeople({ cohort, onChange }: { readonly cohort: Cohort; readonly onChange: (cohort: Cohort) => Promise<void> }) {
  const withdrawn = useMutation({ mutationFn: (name: string) => withdrawInvitation(cohort.id, name), onSuccess: onChange });
  if (cohort.invitations.length === 0) return null;
  return (
    <>
      {withdrawn.isError ? <Notice tone="bad" title="That was not done.">{withdrawn.error.message}</Notice> : null}
      <Table<Invited> caption="Invitations that wait for an answer" rows={cohort.invitations} keyOf={({ name }) => name} empty="" columns={[
        { name: 'Invited', cell: (one) => one.name },
        { name: 'By', cell: (one) => one.made_by },
        { name: 'Sent', cell: (one) => formatDateTime(one.made_utc_us) },
        { name: <span className="hidden-visually">Decide</span>, cell: (one) => <Button look="quiet" label={`Withdraw the invitation: ${one.name}`} disabled={withdrawn.isPending} onClick={() => withdrawn.mutate(one.name)}>Withdraw</Button> },
      ]} />
    </>
  );
}
