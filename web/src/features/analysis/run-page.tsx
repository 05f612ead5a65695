import { useMutation, useQuery, useQueryClient } from '@tanstack/react-query';
import { Link } from 'wouter';
import { analysisFile, analysisQuery, readAnalysisResult, stopAnalysis } from '@/api';
import { say } from '@/language';
import { Badge, Button, Card, Notice, Progress, Skeleton, useTitle } from '@/ui';
import { formatDateTime } from '@/units';
import styles from './analysis.module.css';
import published from './published.json';
import { ResultView } from './result-view';

function Running({ id, share }: { readonly id: string; readonly share: number }) {
  const client = useQueryClient();
  const stopped = useMutation({
    mutationFn: () => stopAnalysis(id),
    onSuccess: () => client.invalidateQueries({ queryKey: analysisQuery(id).queryKey }),
  });
  return (
    <Card title={say('Running')}>
      <Progress done={share} of={1} label={say('Progress')} />
      <Button onClick={() => stopped.mutate()} disabled={stopped.isPending}>
        {stopped.isPending ? say('Stopping…') : say('Cancel')}
      </Button>
      {stopped.isError ? (
        <Notice tone="bad" title={say('The analysis could not be stopped.')}>
          {stopped.error.message}
        </Notice>
      ) : null}
    </Card>
  );
}

/** One run of an analysis: its progress, then its result. */
export function RunPage({ id }: { readonly id: string }) {
  const query = useQuery(analysisQuery(id));
  const run = query.data;
  useTitle(run?.result?.plan.title ?? say('Analysis'));
  const back = (
    <p className={styles.back}>
      <Link href={run?.plan ? `/analysis/plans/${run.plan}` : '/analysis'}>
        {run?.plan ? say('← Plan') : say('← Analysis')}
      </Link>
    </p>
  );
  if (query.isError)
    return (
      <div className={styles.page}>
        {back}
        <Notice tone="bad" title={say('The analysis could not be loaded.')} onRetry={() => void query.refetch()}>
          {query.error.message}
        </Notice>
      </div>
    );
  if (!run)
    return (
      <div className={styles.page}>
        {back}
        <Skeleton width="320px" height="36px" />
        <Skeleton height="320px" />
      </div>
    );
  return (
    <div className={styles.page}>
      {back}
      <div className={styles.head}>
        <div>
          <h1>{run.result?.plan.title ?? say('Analysis')}</h1>
          <p className={styles.lead}>
            {formatDateTime(run.made_utc_us)}, {run.made_by}.{' '}
            {run.plan === null ? (
              <Badge>{say('exploratory')}</Badge>
            ) : (
              <Badge tone="accent">{say('locked plan')}</Badge>
            )}{' '}
            {run.same_digits === true ? (
              <Badge tone="good">{say('reproduced exactly on the same data')}</Badge>
            ) : run.same_digits === false ? (
              <Badge tone="bad">{say('differs from an earlier run on the same data')}</Badge>
            ) : null}
          </p>
        </div>
        <span className={styles.buttons} data-waiting={run.state !== 'done' || undefined}>
          <a href={analysisFile(id, 'report.html')} target="_blank" rel="noreferrer">
            {say('Report (new tab)')}
          </a>
          <a href={analysisFile(id, 'data.csv')} download>
            {say('Data (CSV)')}
          </a>
          <a href={analysisFile(id, 'dictionary.json')} download>
            {say('Data dictionary')}
          </a>
          <a href={analysisFile(id, 'result.json')} download>
            {say('All results (JSON)')}
          </a>
        </span>
      </div>
      {run.state === 'failed' ? (
        <Notice tone="bad" title={say('The analysis failed.')}>
          {run.error}
        </Notice>
      ) : null}
      {run.state === 'cancelled' ? (
        <Notice tone="warn" title={say('The analysis was stopped.')}>
          {run.error}
        </Notice>
      ) : null}
      {run.state === 'queued' || run.state === 'running' ? (
        <>
          <Running id={id} share={run.share} />
          <Skeleton height="640px" />
        </>
      ) : null}
      {run.result ? <ResultView result={run.result} /> : null}
    </div>
  );
}

const kPublished = readAnalysisResult(published);

/** The published probing study's tables, recomputed: what an analysis looks like when it is done. */
export function ExamplePage() {
  useTitle(say('Published tables'));
  return (
    <div className={styles.page}>
      <p className={styles.back}>
        <Link href="/analysis">{say('← Analysis')}</Link>
      </p>
      <div>
        <h1>{say('Published tables, recomputed')}</h1>
        <p className={styles.lead}>
          {say(
            'Tables 2 to 5 of the study of ten surgeons on the probing simulator, computed by the plan that is included in Tractus: published values, recomputed values, and the results of a more suitable analysis.',
          )}
        </p>
      </div>
      <ResultView result={kPublished} />
    </div>
  );
}
