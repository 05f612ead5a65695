import { useMutation, useQueryClient } from '@tanstack/react-query';
import { stopLabRun, type LabRunSummary } from '@/api';
import { say } from '@/language';
import { Button, Notice, Progress } from '@/ui';
import { formatShare } from '@/units';
import styles from './run-state.module.css';

interface Props {
  readonly run: LabRunSummary;
  readonly what: string;
  readonly again: () => void;
}

/** A run that is not done: how far it is and how to stop it, or why it ended and how to try again. */
export function RunState({ run, what, again }: Props) {
  const client = useQueryClient();
  const stopped = useMutation({
    mutationFn: () => stopLabRun(run.id),
    onSuccess: () => client.invalidateQueries({ queryKey: ['lab'] }),
  });
  if (run.state === 'failed')
    return (
      <Notice tone="bad" title={say('{what} failed.', { what })} onRetry={again}>
        {run.error}
      </Notice>
    );
  if (run.state === 'cancelled')
    return (
      <Notice tone="warn" title={say('{what} was cancelled.', { what })} onRetry={again}>
        {say('Nothing was changed.')}
      </Notice>
    );
  const waiting = run.state === 'queued';
  return (
    <div className={styles.state} role="status" data-part="run-state">
      <div className={styles.text}>
        <strong>{waiting ? say('{what}: queued', { what }) : `${what}: ${formatShare(run.share)}`}</strong>
        <span className={styles.phase}>
          {run.phase === ''
            ? waiting
              ? say('The lab runs one job at a time.')
              : say('Reading the measurements.')
            : run.phase}
        </span>
      </div>
      <Progress done={run.share} of={1} label={what} />
      <Button onClick={() => stopped.mutate()} disabled={stopped.isPending}>
        {stopped.isPending ? say('Stopping…') : say('Cancel')}
      </Button>
      {stopped.isError ? (
        <span role="alert">{say('The job could not be stopped: {message}', { message: stopped.error.message })}</span>
      ) : null}
    </div>
  );
}
