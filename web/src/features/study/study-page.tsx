import { useQuery, useQueryClient } from '@tanstack/react-query';
import { useState } from 'react';
import { Link } from 'wouter';
import { ApiError, studyEventsQuery, studyQuery, type Study } from '@/api';
import { marked, say, Sentence } from '@/language';
import { Badge, Button, Card, Facts, Notice, Progress, Skeleton, useTitle } from '@/ui';
import { formatCount, formatDateTime, formatShare, isoDateTime, kNone, share } from '@/units';
import { ActionDialog, type StudyAction } from './action-dialog';
import { Activity } from './activity';
import { People } from './people';
import styles from './study-page.module.css';

const kOrder = { random: marked('random'), balanced: marked('balanced, Williams squares') } as const;
const kRepeat = { at_end: marked('at the end'), at_once: marked('as the next trial'), never: marked('never') } as const;

const sum = (study: Study, what: 'done' | 'planned' | 'judged' | 'recognised') =>
  study.participants.reduce((total, one) => total + one[what], 0);

function Back() {
  return (
    <p className={styles.back}>
      <Link href="/studies">← {say('Studies')}</Link>
    </p>
  );
}

function Head({ study, ask }: { readonly study: Study; readonly ask: (action: StudyAction) => void }) {
  const done = sum(study, 'done'),
    planned = sum(study, 'planned'),
    judged = sum(study, 'judged'),
    recognised = sum(study, 'recognised');
  const complete = planned > 0 && done === planned;
  const trialsDone = say('{done} of {planned} trials done', { done: formatCount(done), planned: formatCount(planned) });
  return (
    <>
      <div className={styles.title}>
        <h1>{study.title}</h1>
        {complete ? (
          <Badge tone="good">{say('complete')}</Badge>
        ) : study.state === 'paused' ? (
          <Badge tone="warn">{say('paused')}</Badge>
        ) : (
          <Badge tone="accent">{say('running')}</Badge>
        )}
        {study.participants.some(({ simulated }) => simulated) ? (
          <Badge tone="warn">{say('simulated surgeons')}</Badge>
        ) : null}
        <span className={styles.action}>
          {study.state === 'paused' ? (
            <Button look="solid" onClick={() => ask({ kind: 'resume-study' })}>
              {say('Resume')}
            </Button>
          ) : (
            <Button disabled={complete} onClick={() => ask({ kind: 'pause-study' })}>
              {say('Pause study')}
            </Button>
          )}
        </span>
      </div>
      <div className={styles.progress}>
        <Progress done={done} of={planned} label={trialsDone} />
        <span role="status">{trialsDone}</span>
      </div>
      <Facts
        facts={[
          { name: say('Short name'), value: study.id },
          { name: say('Participants'), value: formatCount(study.participants.length) },
          {
            name: say('Scenarios × repeats'),
            value: `${formatCount(study.scenarios.length)} × ${formatCount(study.repeats)}`,
          },
          { name: say('Order'), value: say(kOrder[study.ordering]) },
          { name: say('Invalid trials are repeated'), value: say(kRepeat[study.on_invalid]) },
          {
            name: say('Recognised'),
            value:
              judged === 0
                ? kNone
                : say('{recognised} of {judged} ({share})', {
                    recognised: formatCount(recognised),
                    judged: formatCount(judged),
                    share: formatShare(share(recognised / judged)),
                  }),
          },
          {
            name: say('Created'),
            value: (
              <>
                <Sentence
                  text="<time>{date}</time> by {name}"
                  values={{ date: formatDateTime(study.made_utc_us), name: study.made_by }}
                  parts={{ time: (words) => <time dateTime={isoDateTime(study.made_utc_us)}>{words}</time> }}
                />
              </>
            ),
          },
        ]}
      />
    </>
  );
}

function Waiting() {
  return (
    <div className={styles.page} role="status">
      <Back />
      <span className="hidden-visually">{say('Loading the study')}</span>
      <Skeleton width="360px" height="32px" />
      <Skeleton height="20px" />
      <Skeleton height="44px" />
      <Skeleton height="480px" />
    </div>
  );
}

function Failed({ reason, retry }: { readonly reason: Error; readonly retry: () => void }) {
  const missing = reason instanceof ApiError && reason.code === 'not_found';
  return (
    <div className={styles.page}>
      <Back />
      {missing ? (
        <Notice tone="warn" title={say('Study not found.')}>
          {say('Check the address. The study may be on another server.')}
        </Notice>
      ) : (
        <Notice tone="bad" title={say('The study could not be loaded.')} onRetry={retry}>
          {reason.message}
        </Notice>
      )}
    </div>
  );
}

/** Progress of all participants, live. Scenarios of trials to come are not shown. */
export function StudyPage({ id }: { readonly id: string }) {
  const query = useQuery(studyQuery(id));
  const events = useQuery(studyEventsQuery(id));
  const client = useQueryClient();
  const [action, setAction] = useState<StudyAction | null>(null);
  const study = query.data;
  useTitle(study?.title ?? say('Study'));
  if (query.isPending) return <Waiting />;
  if (!study) return <Failed reason={query.error ?? new Error(say('No answer'))} retry={() => void query.refetch()} />;
  const changed = (next: Study) => {
    client.setQueryData(studyQuery(id).queryKey, next);
    void client.invalidateQueries({ queryKey: studyEventsQuery(id).queryKey });
  };
  return (
    <div className={styles.page}>
      <Back />
      <Head study={study} ask={setAction} />
      {query.isError ? (
        <Notice tone="bad" title={say('The study could not be refreshed.')} onRetry={() => void query.refetch()}>
          {query.error.message}
        </Notice>
      ) : null}
      {study.participants.length === 0 ? (
        <Notice title={say('No participants yet.')}>
          {say('Participants appear here as soon as they are enrolled.')}
        </Notice>
      ) : (
        <Card title={say('Participants')}>
          <People study={study} ask={setAction} />
        </Card>
      )}
      <Activity
        events={events.data?.events}
        error={events.isError ? events.error : null}
        retry={() => void events.refetch()}
      />
      {action ? (
        <ActionDialog study={study.id} action={action} onChanged={changed} onClose={() => setAction(null)} />
      ) : null}
    </div>
  );
}
