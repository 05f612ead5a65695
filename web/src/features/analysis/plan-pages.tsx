import { useMutation, useQuery, useQueryClient } from '@tanstack/react-query';
import { useState } from 'react';
import { Link, useLocation, useSearch } from 'wouter';
import { cohortTableQuery, lockPlan, metricsQuery, planQuery, runPlan, type AnalysisRun } from '@/api';
import { marked, say } from '@/language';
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

/** A formula, the same in every language. */
const kExclusion = 'operation_time > 300';

const kLockMeaning = marked(
  'Locking stores a hash of the whole plan with your name and the time. A locked plan can be run any number of times, but it can never be changed.',
);

/** Endpoint and model are chosen and locked before the data are seen. */
export function NewPlanPage() {
  useTitle(say('New plan'));
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
        <Link href="/analysis">{say('← Analysis')}</Link>
      </p>
      <h1>{say('New plan')}</h1>
      <Card title={say('Research question')}>
        <div className={styles.stack}>
          <div className={styles.fields}>
            <Field
              label={say('Title')}
              value={draft.title}
              maxLength={200}
              onChange={(event) => set({ title: event.target.value })}
            />
            <Field
              label={say('Question')}
              value={draft.question}
              maxLength={500}
              placeholder={say('Does experience shorten the operation?')}
              onChange={(event) => set({ question: event.target.value })}
            />
          </div>
          <div className={styles.fields}>
            <Select
              label={say('Endpoint')}
              value={draft.endpoint}
              onChange={(event) => set({ endpoint: event.target.value })}
              options={[
                { value: '', text: say('Choose…') },
                ...endpoints.map(({ name }) => ({ value: name, text: columnName(name, metrics) })),
              ]}
            />
            <Select
              label={
                <Term definition={say('How the p values of the primary analyses are corrected for multiple testing.')}>
                  {say('Correction')}
                </Term>
              }
              value={draft.correction}
              onChange={(event) => set({ correction: event.target.value })}
              options={kCorrections.map((one) => ({ ...one, text: say(one.text) }))}
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
              label={say('Exclude rows where (optional)')}
              value={draft.exclusion}
              placeholder={kExclusion}
              spellCheck={false}
              onChange={(event) => set({ exclusion: event.target.value })}
            />
            <Field
              label={say('Reason')}
              value={draft.reason}
              onChange={(event) => set({ reason: event.target.value })}
            />
          </div>
        </div>
      </Card>
      <Card title={say('Analyses')}>
        <div className={styles.stack}>
          {table.data && rows > 0 ? (
            <QuestionForm
              table={table.data}
              metrics={metrics}
              action={say('Add to plan')}
              busy={false}
              planned
              onAsk={(question) => set({ questions: [...draft.questions, question] })}
            />
          ) : table.isPending ? (
            <Skeleton height="140px" />
          ) : (
            <p className={styles.muted}>{say('Columns become available after the first trial is scored.')}</p>
          )}
          <Table
            caption={say('Analyses of the plan')}
            rows={draft.questions}
            keyOf={(_, i) => String(i)}
            empty={say('No analyses yet.')}
            columns={[
              { name: marked('Question'), cell: (one) => one.question },
              { name: marked('Method'), cell: (one) => one.method },
              { name: marked('Formula'), cell: (one) => <code>{one.formula}</code> },
              {
                name: marked('Family'),
                cell: (one) => (one.primary ? <Badge tone="accent">{say('primary')}</Badge> : say('exploratory')),
              },
              {
                name: <span className="hidden-visually">{say('Actions')}</span>,
                cell: (one) => (
                  <Button
                    look="quiet"
                    label={say('Remove: {question}', { question: one.question })}
                    onClick={() => set({ questions: draft.questions.filter((other) => other !== one) })}
                  >
                    {say('Remove')}
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
          {say('Lock plan…')}
        </Button>
      </div>
      {locking && 'plan' in ready ? (
        <AskDialog
          title={say('Lock this plan')}
          action={say('Lock plan')}
          onClose={() => setLocking(false)}
          onAction={() => lockPlan(ready.plan, study, seen).then(({ id }) => go(`/analysis/plans/${id}`))}
        >
          <p>{kLockMeaning}</p>
          <p>
            {rows === 0
              ? say('No trial has been scored yet: the plan precedes the data.')
              : say('{rows} scored trials already exist.', { rows: formatCount(rows) })}
          </p>
          <label className={styles.check}>
            <input type="checkbox" checked={seen} onChange={(event) => setSeen(event.target.checked)} />{' '}
            {say('I have already seen these data (reanalysis)')}
          </label>
        </AskDialog>
      ) : null}
    </div>
  );
}

const kState: Record<AnalysisRun['state'], 'neutral' | 'accent' | 'good' | 'bad' | 'warn'> = {
  queued: 'neutral',
  running: 'accent',
  done: 'good',
  failed: 'bad',
  cancelled: 'warn',
};

const kStates: Readonly<Record<AnalysisRun['state'], string>> = {
  queued: marked('queued'),
  running: marked('running'),
  done: marked('done'),
  failed: marked('failed'),
  cancelled: marked('cancelled'),
};

/** A locked plan and its runs. */
export function PlanPage({ id }: { readonly id: string }) {
  const client = useQueryClient();
  const [, go] = useLocation();
  const query = useQuery(planQuery(id));
  useTitle(query.data?.title ?? say('Plan'));
  const started = useMutation({
    mutationFn: (snapshot: string | undefined) => runPlan(id, snapshot),
    onSuccess: async (run) => {
      await client.invalidateQueries({ queryKey: ['cohort', 'plans', id] });
      go(`/analysis/runs/${run.id}`);
    },
  });
  const back = (
    <p className={styles.back}>
      <Link href="/analysis">{say('← Analysis')}</Link>
    </p>
  );
  if (query.isError)
    return (
      <div className={styles.page}>
        {back}
        <Notice tone="bad" title={say('The plan could not be loaded.')} onRetry={() => void query.refetch()}>
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
            {say('Locked by {name}, {time}, when {count} trials were scored.', {
              name: plan.made_by,
              time: formatDateTime(plan.made_utc_us),
              count: formatCount(plan.trials_then),
            })}{' '}
            {plan.data_seen ? say('The author had seen the data, so the results are exploratory.') : ''}
          </p>
        </div>
        <Button look="solid" disabled={started.isPending} onClick={() => started.mutate(undefined)}>
          {started.isPending ? say('Starting…') : say('Run on current trials')}
        </Button>
      </div>
      {started.isError ? (
        <Notice tone="bad" title={say('The analysis was not started.')}>
          {started.error.message}
        </Notice>
      ) : null}
      <Card
        title={say('Planned analyses')}
        aside={
          <Term align="end" definition={say(kLockMeaning)}>
            {say('locked')}
          </Term>
        }
      >
        <Table
          caption={say('Planned analyses')}
          rows={plan.plan.analyses}
          keyOf={(one) => one.id}
          empty={say('No analyses.')}
          columns={[
            { name: marked('Question'), cell: (one) => one.question ?? one.id },
            { name: marked('Method'), cell: (one) => one.method },
            { name: marked('Formula'), cell: (one) => <code>{one.formula ?? ''}</code> },
            { name: marked('Family'), cell: (one) => say(one.family ?? 'exploratory') },
          ]}
        />
      </Card>
      <Card title={say('Runs of this plan')}>
        <DataTable<AnalysisRun>
          caption={say('Runs')}
          order={say('newest first')}
          rows={plan.analyses}
          keyOf={(one) => one.id}
          empty={say('This plan has not been run yet.')}
          columns={[
            {
              name: marked('Started'),
              by: (one) => one.made_utc_us,
              cell: (one) => <Link href={`/analysis/runs/${one.id}`}>{formatDateTime(one.made_utc_us)}</Link>,
            },
            {
              name: marked('State'),
              by: (one) => one.state,
              cell: (one) => (
                <Badge tone={kState[one.state]}>
                  {one.state === 'running'
                    ? say('running, {share}', { share: formatShare(one.share) })
                    : say(kStates[one.state])}
                </Badge>
              ),
            },
            {
              name: marked('Data'),
              cell: (one) => (one.snapshot === null ? '–' : <code>{one.snapshot.slice(0, 12)}</code>),
            },
            {
              name: <span className="hidden-visually">{say('Actions')}</span>,
              cell: (one) =>
                one.snapshot === null ? null : (
                  <Button look="quiet" onClick={() => started.mutate(one.snapshot ?? undefined)}>
                    {say('Run again on the same data')}
                  </Button>
                ),
            },
          ]}
        />
      </Card>
    </div>
  );
}
