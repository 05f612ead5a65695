import { useQuery } from '@tanstack/react-query';
import { Link } from 'wouter';
import { analysisFile, analysisQuery, type AnalysisResult } from '@/api';
import { Badge, Card, Notice, Progress, Skeleton, useTitle } from '@/ui';
import { formatDateTime } from '@/units';
import styles from './analysis.module.css';
import published from './published.json';
import { ResultView } from './result-view';

/** One analysis: how far it is, then all that it gave. */
export function RunPage({ id }: { readonly id: string }) {
  const query = useQuery(analysisQuery(id));
  const run = query.data;
  useTitle(run?.result?.plan.title ?? 'Analysis');
  const back = <p className={styles.back}><Link href={run?.plan ? `/analysis/plans/${run.plan}` : '/analysis'}>{run?.plan ? '← The plan' : '← Analysis'}</Link></p>;
  if (query.isError) return <div className={styles.page}>{back}<Notice tone="bad" title="The analysis could not be loaded." onRetry={() => void query.refetch()}>{query.error.message}</Notice></div>;
  if (!run) return <div className={styles.page}>{back}<Skeleton width="320px" height="36px" /><Skeleton height="320px" /></div>;
  return (
    <div className={styles.page}>
      {back}
      <div className={styles.head}>
        <div>
          <h1>{run.result?.plan.title ?? 'Analysis'}</h1>
          <p className={styles.lead}>{formatDateTime(run.made_utc_us)}, {run.made_by}. {run.plan === null ? <Badge>not planned beforehand</Badge> : <Badge tone="accent">by a locked plan</Badge>} {run.same_digits === true ? <Badge tone="good">the same digits as before on these data</Badge> : run.same_digits === false ? <Badge tone="bad">other digits than before on these data</Badge> : null}</p>
        </div>
        {run.state === 'done' ? <span className={styles.buttons}><a href={analysisFile(id, 'report.html')} target="_blank" rel="noreferrer">Report (opens a page)</a><a href={analysisFile(id, 'data.csv')} download>Data</a><a href={analysisFile(id, 'dictionary.json')} download>Dictionary</a><a href={analysisFile(id, 'result.json')} download>All numbers</a></span> : null}
      </div>
      {run.state === 'failed' ? <Notice tone="bad" title="The analysis failed.">{run.error}</Notice> : null}
      {run.state === 'queued' || run.state === 'running' ? <Card title="At work"><Progress done={run.share} of={1} label="Share of the work done" /></Card> : null}
      {run.result ? <ResultView result={run.result} /> : null}
    </div>
  );
}

/** The published probing study's tables, recomputed: what an analysis looks like when it is done. */
export function ExamplePage() {
  useTitle('The published tables');
  return (
    <div className={styles.page}>
      <p className={styles.back}><Link href="/analysis">← Analysis</Link></p>
      <div><h1>The published tables, recomputed</h1><p className={styles.lead}>Tables 2 to 5 of the study of ten surgeons on the probing simulator, by the plan that ships with Tractus: what was printed, what comes out here, and what a better analysis says.</p></div>
      <ResultView result={published as unknown as AnalysisResult} />
    </div>
  );
}
