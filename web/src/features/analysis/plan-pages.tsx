import { useMutation, useQuery, useQueryClient } from '@tanstack/react-query';
import { useState } from 'react';
import { Link, useLocation, useSearch } from 'wouter';
import { cohortTableQuery, lockPlan, metricsQuery, planQuery, runPlan, type AnalysisRun } from '@/api';
import {
  AskDialog,
  Badge,
  Button,
  Card,
  DataTable,
  Field,
  Notice,
  Select,
  Skeleton,
  Table,
  Term,
  useTitle,
} from '@/ui';
import { formatCount, formatDateTime, formatShare } from '@/units';
import styles from './analysis.module.css';
import { kBlankPlan, kCorrections, planOf, type PlanDraft } from './plan-draft';
import { columnName, endpointsOf } from './columns';
import { QuestionForm } from './question-form';

const kLockMeaning =
  'Locking stores a hash of the whole plan with your name and the time. A locked plan can be run any number of times, but it can never be changed.';

/** Endpoint and model are chosen and locked before the data are seen. */
export function NewPlanPage() {
  useTitle('New plan');
  const study = new URLSearchParams(useSearch()).get('study') ?? '';
  const [, go] = useLocation();
  const table = useQuery(cohortTableQuery(study)),
    metrics = useQuery(metricsQuery).data?.metrics ?? [];
  const [draft, setDraft] = useState<PlanDraft>(kBlankPlan);
  const [locking, setLocking] = useState(false);
  const [seen, setSeen] = useState(false);
  const set = (changes: Partial<PlanDraft>) => setDraft((before) => ({ ...before, ...changes }));
  const ready = planOf(draft);
  const endpoints = table.data ? endpointsOf(table.data) : [];
  const rows = table.data?.rows.length ?? 0;
  return (
    <div className={styles.page}>
      <p className={styles.back}>
        <Link href="/analysis">← Analysis</Link>
      </p>
      <h1>New plan</h1>
      <Card title="Research question">
        <div className={styles.stack}>
          <div className={styles.fields}>
            <Field
              label="Title"
              value={draft.title}
              maxLength={200}
              onChange={(event) => set({ title: event.target.value })}
            />
            <Field
              label="Question"
              value={draft.question}
              maxLength={500}
              placeholder="Does experience shorten the operation?"
              onChange={(event) => set({ question: event.target.value })}
            />
          </div>
          <div className={styles.fields}>
            <Select
              label="Endpoint"
              value={draft.endpoint}
              onChange={(event) => set({ endpoint: event.target.value })}
              options={[
                { value: '', text: 'Choose…' },
                ...endpoints.map(({ name }) => ({ value: name, text: columnName(name, metrics) })),
              ]}
            />
            <Select
              label={
                <Term definition="How the p values of the primary analyses are corrected for multiple testing.">
                  Correction
                </Term>
              }
              value={draft.correction}
              onChange={(event) => set({ correction: event.target.value })}
              options={kCorrections}
            />
            <Field
              label="α"
              value={draft.alpha}
              inputMode="decimal"
              onChange={(event) => set({ alpha: event.target.value })}
            />
          </div>
          <div className={styles.fields}>
            <Field
              label="Exclude rows where (optional)"
              value={draft.exclusion}
              placeholder="operation_time > 300"
              spellCheck={false}
              onChange={(event) => set({ exclusion: event.target.value })}
            />
            <Field label="Reason" value={draft.reason} onChange={(event) => set({ reason: event.target.value })} />
          </div>
        </div>
      </Card>
      <Card title="Analyses">
        <div className={styles.stack}>
          {table.data && rows > 0 ? (
            <QuestionForm
              table={table.data}
              metrics={metrics}
              action="Add to plan"
              busy={false}
              planned
              onAsk={(question) => set({ questions: [...draft.questions, question] })}
            />
          ) : table.isPending ? (
            <Skeleton height="140px" />
          ) : (
            <p className={styles.muted}>Columns become available after the first trial is scored.</p>
          )}
          <Table
            caption="Analyses of the plan"
            rows={draft.questions}
            keyOf={(_, i) => String(i)}
            empty="No analyses yet."
            columns={[
              { name: 'Question', cell: (one) => one.question },
              { name: 'Method', cell: (one) => one.method },
              { name: 'Formula', cell: (one) => <code>{one.formula}</code> },
              { name: 'Family', cell: (one) => (one.primary ? <Badge tone="accent">primary</Badge> : 'exploratory') },
              {
                name: <span className="hidden-visually">Actions</span>,
                cell: (one) => (
                  <Button
                    look="quiet"
                    label={`Remove: ${one.question}`}
                    onClick={() => set({ questions: draft.questions.filter((other) => other !== one) })}
                  >
                    Remove
                  </Button>
                ),
              },
            ]}
          />
        </div>
      </Card>
      <div className={styles.end}>
        <p className={styles.muted} role="status">
          {'missing' in ready ? ready.missing : ''}
        </p>
        <Button look="solid" disabled={!('plan' in ready)} onClick={() => setLocking(true)}>
          Lock plan…
        </Button>
      </div>
      {locking && 'plan' in ready ? (
        <AskDialog
          title="Lock this plan"
          action="Lock plan"
          onClose={() => setLocking(false)}
          onAction={() => lockPlan(ready.plan, study, seen).then(({ id }) => go(`/analysis/plans/${id}`))}
        >
          <p>{kLockMeaning}</p>
          <p>
            {rows === 0
              ? 'No trial has been scored yet: the plan precedes the data.'
              : `${formatCount(rows)} scored trials already exist.`}
          </p>
          <label className={styles.check}>
            <input type="checkbox" checked={seen} onChange={(event) => setSeen(event.target.checked)} /> I have already
            seen these data (reanalysis)
          </label>
        </AskDialog>
      ) : null}
    </div>
  );
}

const kState: Record<AnalysisRun['state'], 'neutral' | 'accent' | 'good' | 'bad'> = {
  queued: 'neutral',
  running: 'accent',
  done: 'good',
  failed: 'bad',
};

/** A locked plan and its runs. */
export function PlanPage({ id }: { readonly id: string }) {
  const client = useQueryClient();
  const [, go] = useLocation();
  const query = useQuery(planQuery(id));
  useTitle(query.data?.title ?? 'Plan');
  const started = useMutation({
    mutationFn: (snapshot: string | undefined) => runPlan(id, snapshot),
    onSuccess: async (run) => {
      await client.invalidateQueries({ queryKey: ['cohort', 'plans', id] });
      go(`/analysis/runs/${run.id}`);
    },
  });
  const back = (
    <p className={styles.back}>
      <Link href="/analysis">← Analysis</Link>
    </p>
  );
  if (query.isError)
    return (
      <div className={styles.page}>
        {back}
        <Notice tone="bad" title="The plan could not be loaded." onRetry={() => void query.refetch()}>
          {query.error.message}
        </Notice>
      </div>
    );
  if (!query.data)
    return (
      <div className={styles.page}>
        {back}
        <Skeleton width="320px" height="36px" />
        <Skeleton height="240px" />
      </div>
    );
  const plan = query.data;
  return (
    <div className={styles.page}>
      {back}
      <div className={styles.head}>
        <div>
          <h1>{plan.title}</h1>
          <p className={styles.lead}>
            Locked by {plan.made_by}, {formatDateTime(plan.made_utc_us)}, when {formatCount(plan.trials_then)} trials
            were scored. {plan.data_seen ? 'The author had seen the data, so the results are exploratory.' : ''}
          </p>
        </div>
        <Button look="solid" disabled={started.isPending} onClick={() => started.mutate(undefined)}>
          {started.isPending ? 'Starting…' : 'Run on current trials'}
        </Button>
      </div>
      {started.isError ? (
        <Notice tone="bad" title="The analysis was not started.">
          {started.error.message}
        </Notice>
      ) : null}
      <Card
        title="Planned analyses"
        aside={
          <Term align="end" definition={kLockMeaning}>
            locked
          </Term>
        }
      >
        <Table
          caption="Planned analyses"
          rows={plan.plan.analyses}
          keyOf={(one) => one.id}
          empty="No analyses."
          columns={[
            { name: 'Question', cell: (one) => one.question ?? one.id },
            { name: 'Method', cell: (one) => one.method },
            { name: 'Formula', cell: (one) => <code>{one.formula ?? ''}</code> },
            { name: 'Family', cell: (one) => one.family ?? 'exploratory' },
          ]}
        />
      </Card>
      <Card title="Runs of this plan">
        <DataTable<AnalysisRun>
          caption="Runs"
          order="newest first"
          rows={plan.analyses}
          keyOf={(one) => one.id}
          empty="This plan has not been run yet."
          columns={[
            {
              name: 'Started',
              by: (one) => one.made_utc_us,
              cell: (one) => <Link href={`/analysis/runs/${one.id}`}>{formatDateTime(one.made_utc_us)}</Link>,
            },
            {
              name: 'State',
              by: (one) => one.state,
              cell: (one) => (
                <Badge tone={kState[one.state]}>
                  {one.state === 'running' ? `running, ${formatShare(one.share)}` : one.state}
                </Badge>
              ),
            },
            { name: 'Data', cell: (one) => (one.snapshot === null ? '–' : <code>{one.snapshot.slice(0, 12)}</code>) },
            {
              name: <span className="hidden-visually">Actions</span>,
              cell: (one) =>
                one.snapshot === null ? null : (
                  <Button look="quiet" onClick={() => started.mutate(one.snapshot ?? undefined)}>
                    Run again on the same data
                  </Button>
                ),
            },
          ]}
        />
      </Card>
    </div>
  );
}
