import { useMutation, useQuery } from '@tanstack/react-query';
import { useState } from 'react';
import { Link, useLocation } from 'wouter';
import {
  cohortTableAddress,
  cohortTableQuery,
  metricsQuery,
  plansQuery,
  runMethod,
  sessionQuery,
  studiesQuery,
  type PlanSummary,
} from '@/api';
import { marked, say, Sentence } from '@/language';
import { Badge, Card, DataTable, Facts, Notice, Select, Skeleton, useTitle } from '@/ui';
import { formatCount, formatDateTime } from '@/units';
import styles from './analysis.module.css';
import { CompareForm, type Comparison } from './compare-form';
import type { Question } from './plan-draft';
import { QuestionForm } from './question-form';

/** The trial data, a quick analysis of them, and the locked plans. */
export function AnalysisPage() {
  useTitle(say('Analysis'));
  const [, go] = useLocation();
  const [study, setStudy] = useState('');
  const role = useQuery({ ...sessionQuery, enabled: false }).data?.role;
  // Studies are for researchers: a director analyses all scored trials.
  const studies = useQuery({ ...studiesQuery, enabled: role !== undefined && role !== 'director' }).data?.studies ?? [];
  const table = useQuery(cohortTableQuery(study)),
    metrics = useQuery(metricsQuery).data?.metrics ?? [];
  const plans = useQuery(plansQuery);
  const started = useMutation({
    mutationFn: ({
      method,
      formula,
      options,
    }: Pick<Question, 'method' | 'formula'> & Partial<Pick<Comparison, 'options'>>) =>
      runMethod(method, formula, study, options),
    onSuccess: ({ id }) => go(`/analysis/runs/${id}`),
  });
  const rows = table.data?.rows ?? [],
    people = new Set(rows.map(({ participant }) => participant)).size,
    simulated = rows.filter((row) => row.simulated === '1').length;
  return (
    <div className={styles.page}>
      <div className={styles.head}>
        <div>
          <h1>{say('Analysis')}</h1>
          <p className={styles.lead}>
            {say(
              'Analyse trial data: run a plan that was locked before the data were seen, or run a single method now. Every result can be recomputed.',
            )}
          </p>
        </div>
        <span className={styles.buttons}>
          <Link href="/analysis/example">{say('Published tables, recomputed')}</Link>
          <Link
            href={`/analysis/plans/new${study === '' ? '' : `?study=${encodeURIComponent(study)}`}`}
            className={styles.solidLink}
          >
            {say('New plan')}
          </Link>
        </span>
      </div>
      <Card
        title={say('Trial data')}
        aside={
          <span className={styles.buttons}>
            <Select
              label={<span className="hidden-visually">{say('Study')}</span>}
              value={study}
              onChange={(event) => setStudy(event.target.value)}
              options={[
                { value: '', text: say('All scored trials') },
                ...studies.map(({ id, title }) => ({ value: id, text: title })),
              ]}
            />
            <a href={cohortTableAddress(study)} download="cohort.csv">
              {say('Download CSV')}
            </a>
          </span>
        }
      >
        {table.isError ? (
          <Notice tone="bad" title={say('The trial data could not be loaded.')} onRetry={() => void table.refetch()}>
            {table.error.message}
          </Notice>
        ) : null}
        <div className={styles.holdsFacts}>
          {table.isPending ? (
            <Skeleton height="52px" />
          ) : (
            <Facts
              facts={[
                { name: say('Valid, scored trials'), value: <strong>{formatCount(rows.length)}</strong> },
                { name: say('Participants'), value: <strong>{formatCount(people)}</strong> },
                {
                  name: say('Simulated trials'),
                  value: simulated > 0 ? <Badge tone="warn">{formatCount(simulated)}</Badge> : say('none'),
                },
                { name: say('Columns'), value: formatCount(table.data?.columns.length ?? 0) },
              ]}
            />
          )}
        </div>
      </Card>
      <Card title={say('Compare cohorts')} aside={<Badge>{say('exploratory')}</Badge>}>
        <div className={styles.holdsCompare}>
          {table.data ? (
            <CompareForm
              key={study}
              table={table.data}
              metrics={metrics}
              busy={started.isPending}
              onCompare={(asked) => started.mutate(asked)}
            />
          ) : table.isPending ? (
            <Skeleton height="120px" />
          ) : null}
        </div>
      </Card>
      <Card title={say('Quick analysis')} aside={<Badge>{say('exploratory')}</Badge>}>
        <div className={styles.holdsForm}>
          {table.data && rows.length > 0 ? (
            <QuestionForm
              key={study}
              table={table.data}
              metrics={metrics}
              action={say('Run analysis')}
              busy={started.isPending}
              onAsk={(question) => started.mutate(question)}
            />
          ) : table.isPending ? (
            <Skeleton height="140px" />
          ) : (
            <p className={styles.muted}>
              <Sentence
                text="No trial has been scored yet. <link>See an example with the published study.</link>"
                parts={{ link: (words) => <Link href="/analysis/example">{words}</Link> }}
              />
            </p>
          )}
        </div>
        {started.isError ? (
          <Notice tone="bad" title={say('The analysis was not started.')}>
            {started.error.message}
          </Notice>
        ) : null}
      </Card>
      <Card title={say('Locked plans')}>
        {plans.isError ? (
          <Notice tone="bad" title={say('The plans could not be loaded.')} onRetry={() => void plans.refetch()}>
            {plans.error.message}
          </Notice>
        ) : (
          <DataTable<PlanSummary>
            caption={say('Locked plans')}
            order={say('newest first')}
            rows={plans.data?.plans}
            keyOf={({ id }) => id}
            empty={say('No plan has been locked yet.')}
            columns={[
              {
                name: marked('Plan'),
                by: (one) => one.title,
                cell: (one) => <Link href={`/analysis/plans/${one.id}`}>{one.title}</Link>,
              },
              { name: marked('Data'), by: (one) => one.study, cell: (one) => one.study ?? say('all trials') },
              {
                name: marked('Locked'),
                by: (one) => one.made_utc_us,
                cell: (one) => `${formatDateTime(one.made_utc_us)}, ${one.made_by}`,
              },
              {
                name: marked('Trials when locked'),
                by: (one) => one.trials_then,
                cell: (one) => formatCount(one.trials_then),
                number: true,
              },
              {
                name: marked('Timing'),
                cell: (one) =>
                  one.data_seen || one.trials_then > 0 ? (
                    <Badge tone="warn">{say('data already existed')}</Badge>
                  ) : (
                    <Badge tone="good">{say('locked before data')}</Badge>
                  ),
              },
            ]}
          />
        )}
      </Card>
    </div>
  );
}
