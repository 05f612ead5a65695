import type { StudyEvent } from '@/api';
import { say } from '@/language';
import { Card, Notice, Skeleton } from '@/ui';
import { formatClock, isoDateTime } from '@/units';
import styles from './activity.module.css';
import { eventSentence } from './labels';

interface Props {
  readonly events: readonly StudyEvent[] | undefined;
  readonly error: Error | null;
  readonly retry: () => void;
}

/** The latest changes, who and when; the list has a height of its own, so that nothing jumps while it grows. */
export function Activity({ events, error, retry }: Props) {
  return (
    <Card title={say('Activity')}>
      {error ? (
        <Notice tone="bad" title={say('The changes could not be loaded.')} onRetry={retry}>
          {error.message}
        </Notice>
      ) : null}
      {/* eslint-disable-next-line jsx-a11y/no-noninteractive-tabindex -- a region that scrolls takes the keys that scroll it */}
      <div className={styles.list} role="region" aria-label={say('Changes, newest first')} tabIndex={0}>
        {events === undefined && !error ? (
          <Skeleton height="120px" />
        ) : (
          <ol>
            {events?.map((event, i) => (
              <li key={`${event.at_utc_us}-${events.length - i}`}>
                <time dateTime={isoDateTime(event.at_utc_us)}>{formatClock(event.at_utc_us)}</time>
                <span>{eventSentence(event)}</span>
              </li>
            ))}
          </ol>
        )}
      </div>
    </Card>
  );
}
