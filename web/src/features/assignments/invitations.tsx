import { useMutation, useQuery, useQueryClient } from '@tanstack/react-query';
import { acceptInvitation, declineInvitation, invitationsQuery, kAssignmentLists, type Invitation } from '@/api';
import { Button, Card, Notice, Table } from '@/ui';
import { formatDateTime } from '@/units';
import styles from './assignments.module.css';

/** Invitations of the signed-in person into cohorts; empty without any. */
export function Invitations() {
  const client = useQueryClient();
  const query = useQuery(invitationsQuery);
  const answered = useMutation({
    mutationFn: ({ cohort, accepts }: { readonly cohort: string; readonly accepts: boolean }) =>
      accepts ? acceptInvitation(cohort) : declineInvitation(cohort),
    onSuccess: async (list) => {
      client.setQueryData(invitationsQuery.queryKey, list);
      await client.invalidateQueries({ queryKey: kAssignmentLists });
    },
  });
  const decide = (one: Invitation, accepts: boolean) => answered.mutate({ cohort: one.cohort_id, accepts });
  const list = query.data?.invitations ?? [];
  if (list.length === 0) return null;
  return (
    <Card title="Invitations">
      <div className={styles.stack}>
        <p>
          Faculty who lead a cohort see the trials of all its members and set their badges and PINs. You join only if
          you accept.
        </p>
        {answered.isError ? (
          <Notice tone="bad" title="The action failed.">
            {answered.error.message}
          </Notice>
        ) : null}
        <Table<Invitation>
          caption="Cohort invitations"
          rows={list}
          keyOf={({ cohort_id }) => cohort_id}
          empty=""
          columns={[
            { name: 'Cohort', cell: (one) => one.cohort_name },
            { name: 'From', cell: (one) => one.made_by },
            { name: 'Sent', cell: (one) => formatDateTime(one.made_utc_us) },
            {
              name: <span className="hidden-visually">Answer</span>,
              cell: (one) => (
                <span className={styles.buttons}>
                  <Button
                    label={`Accept: ${one.cohort_name}`}
                    disabled={answered.isPending}
                    onClick={() => decide(one, true)}
                  >
                    Accept
                  </Button>
                  <Button
                    look="quiet"
                    label={`Decline: ${one.cohort_name}`}
                    disabled={answered.isPending}
                    onClick={() => decide(one, false)}
                  >
                    Decline
                  </Button>
                </span>
              ),
            },
          ]}
        />
      </div>
    </Card>
  );
}
