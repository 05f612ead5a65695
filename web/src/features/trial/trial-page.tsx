import { useQuery } from '@tanstack/react-query';
import { useMemo, useState, type ReactNode } from 'react';
import { Link } from 'wouter';
import { ApiError, forceDepthQuery, trialQuery, type Trial, personOf } from '@/api';
import { makeCursor, type Cursor } from '@/charts';
import { say } from '@/language';
import { Badge, Card, Facts, Notice, Skeleton, useTitle } from '@/ui';
import { formatCount, formatDateTime, formatDateTimeLong, formatDuration, formatRate, isoDateTime } from '@/units';
import { breachMarks } from './breaches';
import { DepthPanel } from './depth-panel';
import { Measures } from './measures';
import { StudyPosition } from './study-position';
import { Recording } from './recording';
import { SignalsPanel } from './signals-panel';
import { TractPanel } from './tract-panel';
import styles from './trial-page.module.css';
import { Verdict } from './verdict';
import { WallsPanel } from './walls-panel';

function Header({ trial }: { readonly trial: Trial }) {
  return (
    <>
      <p className={styles.back}>
        <Link href="/trials">← {say('Trials')}</Link> ·{' '}
        <Link href={`/trials/${trial.id}/debrief`}>{say('Debrief')}</Link>
      </p>
      <div className={styles.title}>
        <h1>{trial.case_title}</h1>
        {trial.simulated ? <Badge tone="warn">{say('simulated')}</Badge> : null}
        {trial.complete ? null : <Badge tone="bad">{say('incomplete recording')}</Badge>}
      </div>
      {trial.study ? <StudyPosition position={trial.study} person={trial.person} /> : null}
      <div className={styles.facts}>
        <Facts
          facts={[
            { name: say('Person'), value: personOf(trial) },
            {
              name: say('Started'),
              value: (
                <time dateTime={isoDateTime(trial.started_utc_us)} title={formatDateTimeLong(trial.started_utc_us)}>
                  {formatDateTime(trial.started_utc_us)}
                </time>
              ),
            },
            { name: say('Duration'), value: formatDuration(trial.duration_s) },
            { name: say('Station'), value: trial.station },
            { name: say('Device'), value: trial.device },
            {
              name: say('Recorded'),
              value: say('{samples} samples at {rate}', {
                samples: formatCount(trial.samples),
                rate: formatRate(trial.rate_Hz),
              }),
            },
          ]}
        />
      </div>
    </>
  );
}

function Frame({ children }: { readonly children: ReactNode }) {
  return <div className={styles.page}>{children}</div>;
}

function Waiting() {
  return (
    <Frame>
      <p className={styles.back}>
        <Link href="/trials">← {say('Trials')}</Link>
      </p>
      <div role="status" className={styles.waiting}>
        <span className="hidden-visually">{say('Loading the trial')}</span>
        <Skeleton width="360px" height="32px" />
        <Skeleton height="40px" />
        <Skeleton height="132px" />
        <Skeleton height="640px" />
      </div>
    </Frame>
  );
}

function Failed({ reason, retry }: { readonly reason: Error; readonly retry: () => void }) {
  const missing = reason instanceof ApiError && reason.code === 'not_found';
  return (
    <Frame>
      <p className={styles.back}>
        <Link href="/trials">← {say('Trials')}</Link>
      </p>
      {missing ? (
        <Notice tone="warn" title={say('Trial not found.')}>
          {say('Check the address. The trial may be on another server.')}
        </Notice>
      ) : (
        <Notice tone="bad" title={say('The trial could not be loaded.')} onRetry={retry}>
          {reason.message}
        </Notice>
      )}
    </Frame>
  );
}

interface Views {
  readonly trial: Trial;
  readonly cursor: Cursor;
}

function Palpation({ trial, cursor }: Views) {
  return (
    <>
      <Card title={say('Signals')}>
        <SignalsPanel trial={trial} cursor={cursor} />
      </Card>
      <div className={styles.views}>
        <TractPanel trial={trial} cursor={cursor} />
        <WallsPanel trial={trial} cursor={cursor} />
      </div>
    </>
  );
}

function Probing({ trial, cursor }: Views) {
  const curve = useQuery(forceDepthQuery(trial.id));
  const breaches = useMemo(() => breachMarks(curve.data), [curve.data]);
  return (
    <>
      <Card title={say('Signals')}>
        <SignalsPanel trial={trial} cursor={cursor} further={breaches} />
      </Card>
      <DepthPanel trial={trial} cursor={cursor} />
    </>
  );
}

/** One trial: what was found, what was felt, where the tip was, and how well it was recorded. */
export function TrialPage({ id }: { readonly id: string }) {
  const query = useQuery(trialQuery(id));
  const [cursor] = useState(makeCursor);
  const trial = query.data;
  useTitle(trial ? `${trial.case_title}, ${personOf(trial)}` : say('Trial'));
  if (query.isPending) return <Waiting />;
  if (!trial) return <Failed reason={query.error ?? new Error(say('No answer'))} retry={() => void query.refetch()} />;
  return (
    <Frame>
      <Header trial={trial} />
      {trial.state === 'assessing' ? (
        <Notice title={say('This trial is being assessed.')}>
          {say('Measures, walls and the verdict appear here after the assessment.')}
        </Notice>
      ) : null}
      {trial.state === 'failed' ? (
        <Notice tone="warn" title={say('The assessment of this trial failed.')}>
          {trial.failure ?? say('The measures could not be computed.')} {say('The recording is shown below.')}
        </Notice>
      ) : null}
      <div className={styles.pair}>
        <Verdict trial={trial} />
        <Recording trial={trial} />
      </div>
      {trial.rig === 'probing' ? (
        <Probing trial={trial} cursor={cursor} />
      ) : (
        <Palpation trial={trial} cursor={cursor} />
      )}
      <Measures metrics={trial.metrics} state={trial.state} />
    </Frame>
  );
}
