import { useMutation, useQuery, useQueryClient } from '@tanstack/react-query';
import { acceptInvitation, declineInvitation, invitationsQuery, kAssignmentLists, type Invitation } from '@/api';
import { say } from '@/language';
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
    <Card title={say('Invitations')}>
      <div className={styles.stack}>
        <p>
          {say(
            'Faculty who lead a cohort see the trials of all its members and set their badges and PINs. You join only if you accept.',
          )}
        </p>
        {answered.isError ? (
          <Notice tone="bad" title={say('The action failed.')}>
            {answered.error.message}
          </Notice>
        ) : null}
        <Table<Invitation>
          caption={say('Cohort invitations')}
          rows={list}
          keyOf={({ cohort_id }) => cohort_id}
          empty=""
          columns={[
            { name: say('Cohort'), cell: (one) => one.cohort_name },
            { name: say('From'), cell: (one) => one.made_by },
            { name: say('Sent'), cell: (one) => formatDateTime(one.made_utc_us) },
            {
              name: <span className="hidden-visually">{say('Answer')}</span>,
              cell: (one) => (
                <span className={styles.buttons}>
                  <Button
                    label={say('Accept: {cohort_name}', { cohort_name: one.cohort_name })}
                    disabled={answered.isPending}
                    onClick={() => decide(one, true)}
                  >
                    {say('Accept')}
                  </Button>
                  <Button
                    look="quiet"
                    label={say('Decline: {cohort_name}', { cohort_name: one.cohort_name })}
                    disabled={answered.isPending}
                    onClick={() => decide(one, false)}
                  >
                    {say('Decline')}
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
