import { useQuery } from '@tanstack/react-query';
import { Link } from 'wouter';
import { ApiError, heard, metricsQuery, sessionQuery, traineeQuery, type Attempt, type Trainee } from '@/api';
import { say } from '@/language';
import { Badge, Button, Card, DataTable, Facts, Notice, Skeleton, Term, useTitle } from '@/ui';
import { formatCount, formatDateTime, formatShare } from '@/units';
import { CusumChart } from './cusum-chart';
import { LearningChart } from './learning-chart';
import { ByScenario, Calibration } from './recognition';
import styles from './trainees.module.css';
import { kCalibration, kCusum, kInterval, kRelapse, kStateLabels } from './terms';

function Head({ trainee }: { readonly trainee: Trainee }) {
  const state = kStateLabels[trainee.state];
  return (
    <Card title={say('Summary')} aside={<Badge tone={state.tone}>{say(state.label)}</Badge>}>
      <div className={styles.stack}>
        <Facts
          facts={[
            {
              name: <Term definition={say(kInterval)}>{say('Correct answers')}</Term>,
              value: (
                <strong className={styles.big}>
                  {say('{right} of {trials}', {
                    right: formatCount(trainee.right),
                    trials: formatCount(trainee.trials),
                  })}
                </strong>
              ),
            },
            {
              name: say('Share'),
              value: (
                <>
                  <strong className={styles.big}>{formatShare(trainee.share)}</strong>{' '}
                  <span className={styles.muted}>
                    {formatShare(trainee.wilson_low)}–{formatShare(trainee.wilson_high)}
                  </span>
                </>
              ),
            },
            ...(trainee.next.scenario === ''
              ? []
              : [{ name: say('Next case'), value: <strong>{trainee.next.scenario}</strong> }]),
            { name: say('Last trial'), value: formatDateTime(trainee.last_utc_us) },
          ]}
        />
        <p>
          {say(state.description)}{' '}
          {trainee.certified
            ? say('Competence can be certified: {why}.', { why: heard(trainee.why) })
            : say('Competence cannot be certified: {why}.', { why: heard(trainee.why) })}
        </p>
        {trainee.next.why === '' ? null : (
          <p className={styles.muted}>{say('Next: {why}.', { why: heard(trainee.next.why) })}</p>
        )}
      </div>
    </Card>
  );
}

function Attempts({ trainee, mayOpen }: { readonly trainee: Trainee; readonly mayOpen: boolean }) {
  return (
    <Card title={say('Trials')} className={styles.unprinted ?? ''}>
      <DataTable<Attempt>
        caption={say('Trials')}
        order={say('newest first')}
        rows={[...trainee.attempts].reverse()}
        keyOf={({ number }) => String(number)}
        empty={say('No trials.')}
        columns={[
          {
            name: say('Trial'),
            by: (one) => one.number,
            cell: (one) =>
              mayOpen && one.trial !== null ? (
                <Link href={`/trials/${encodeURIComponent(one.trial)}`}>{formatCount(one.number)}</Link>
              ) : (
                formatCount(one.number)
              ),
          },
          {
            name: say('Started'),
            by: (one) => one.started_utc_us ?? 0,
            cell: (one) => (one.started_utc_us === null ? say('rated blind') : formatDateTime(one.started_utc_us)),
          },
          { name: say('Scenario'), by: (one) => one.scenario, cell: (one) => one.scenario },
          {
            name: say('Answer'),
            by: (one) => one.correct,
            cell: (one) => (
              <Badge tone={one.correct ? 'good' : 'bad'}>{one.correct ? say('✓ correct') : say('✗ incorrect')}</Badge>
            ),
          },
          {
            name: say('Confidence'),
            cell: (one) => (one.confidence === null ? '–' : formatShare(one.confidence)),
            number: true,
          },
        ]}
      />
    </Card>
  );
}

/** One trainee on one printable page. */
export function TraineePage({ name }: { readonly name: string }) {
  useTitle(name);
  const query = useQuery(traineeQuery(name)),
    metricsFound = useQuery(metricsQuery);
  const metrics = metricsFound.data?.metrics ?? [];
  const role = useQuery({ ...sessionQuery, enabled: false }).data?.role;
  const trainee = query.data;
  const back =
    role === 'trainee' ? null : (
      <p className={styles.back}>
        <Link href="/trainees">← {say('Trainees')}</Link>
      </p>
    );
  if (query.isError) {
    const missing = query.error instanceof ApiError && query.error.code === 'not_found';
    return (
      <div className={styles.page}>
        {back}
        <h1>{name}</h1>
        {missing ? (
          <Notice title={role === 'trainee' ? say('No results yet.') : say('No scored trials for this name.')}>
            {role === 'trainee'
              ? say('Your progress appears here after your trials are scored and the results are released.')
              : say('Check the address. The trials may not be scored yet.')}
          </Notice>
        ) : (
          <Notice tone="bad" title={say('The page could not be loaded.')} onRetry={() => void query.refetch()}>
            {query.error.message}
          </Notice>
        )}
      </div>
    );
  }
  // Both at once: the chart grows by its choice of metrics, and what is below would jump.
  if (!trainee || metricsFound.isPending)
    return (
      <div className={styles.page}>
        {back}
        <Skeleton width="280px" height="36px" />
        <Skeleton height="140px" />
        <Skeleton height="320px" />
      </div>
    );
  return (
    <div className={styles.page}>
      {back}
      <div className={styles.head}>
        <h1>
          {trainee.trainee} {trainee.simulated ? <Badge tone="warn">{say('simulated')}</Badge> : null}
        </h1>
        <Button onClick={() => window.print()}>{say('Print this page')}</Button>
      </div>
      <Head trainee={trainee} />
      <div className={styles.two}>
        <Card title={say('Learning')}>
          <LearningChart trainee={trainee} metrics={metrics} />
        </Card>
        <Card
          title={say('Competence')}
          aside={
            <Term align="end" definition={`${say(kCusum)} ${say(kRelapse)}`}>
              {say('how to read this chart')}
            </Term>
          }
        >
          <CusumChart trainee={trainee} />
        </Card>
        <Card title={say('Recognition by scenario')}>
          <ByScenario trainee={trainee} />
        </Card>
        <Card
          title={say('Confidence')}
          aside={
            <Term align="end" definition={say(kCalibration)}>
              {say('how to read this chart')}
            </Term>
          }
        >
          <Calibration bins={trainee.calibration} />
        </Card>
      </div>
      <Attempts trainee={trainee} mayOpen />
    </div>
  );
}
