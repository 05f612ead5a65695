import { useMutation, useQuery, useQueryClient } from '@tanstack/react-query';
import { useState } from 'react';
import { Link, useLocation, useSearch } from 'wouter';
import { cohortTableQuery, lockPlan, metricsQuery, planQuery, runPlan, type AnalysisRun } from '@/api';
import { AskDialog, Badge, Button, Card, Field, Notice, Select, Skeleton, Table, Term, useTitle } from '@/ui';
import { formatCount, formatDateTime, formatShare } from '@/units';
import styles from './analysis.module.css';
import { kBlankPlan, kCorrections, planOf, type PlanDraft } from './plan-draft';
import { columnName, QuestionForm } from './question-form';

const kLockMeaning = 'A locked plan has its hash taken over every word, with your name and the time. It can be run, again and again, but never changed.';

/** Endpoint and model are chosen and locked before the data are seen. */
export function NewPlanPage() {
  useTitle('New plan');
  const study = new URLSearchParams(useSearch()).get('study') ?? '';
  const [, go] = useLocation();
  const table = useQuery(cohortTableQuery(study)), metrics = useQuery(metricsQuery).data?.metrics ?? [];
  const [draft, setDraft] = useState<PlanDraft>(kBlankPlan);
  const [locking, setLocking] = useState(false);
  const [seen, setSeen] = useState(false);
  const set = (changes: Partial<PlanDraft>) => setDraft((before) => ({ ...before, ...changes }));
  const ready = planOf(draft);
  const endpoints = (table.data?.columns ?? []).filter(({ name, numbers }) => numbers && name !== 'simulated');
  const rows = table.data?.rows.length ?? 0;
  return (
    <div className={styles.page}>
      <p className={styles.back}><Link href="/analysis">← Analysis</Link></p>
      <h1>New plan</h1>
      <Card title="What is asked">
        <div className={styles.stack}>
          <div className={styles.fields}><Field label="Title" value={draft.title} maxLength={200} onChange={(event) => set({ title: event.target.value })} /><Field label="Question" value={draft.question} maxLength={500} placeholder="Does experience shorten the operation?" onChange={(event) => set({ question: event.target.value })} /></div>
          <div className={styles.fields}>
            <Select label="Endpoint" value={draft.endpoint} onChange={(event) => set({ endpoint: event.target.value })} options={[{ value: '', text: 'Choose…' }, ...endpoints.map(({ name }) => ({ value: name, text: columnName(name, metrics) }))]} />
            <Select label={<Term definition="How the p values of the primary analyses are corrected for being several.">Correction</Term>} value={draft.correction} onChange={(event) => set({ correction: event.target.value })} options={kCorrections} />
            <Field label="α" value={draft.alpha} inputMode="decimal" onChange={(event) => set({ alpha: event.target.value })} />
          </div>
          <div className={styles.fields}><Field label="Leave out rows where (may be left empty)" value={draft.exclusion} placeholder="operation_time > 300" spellCheck={false} onChange={(event) => set({ exclusion: event.target.value })} /><Field label="Why" value={draft.reason} onChange={(event) => set({ reason: event.target.value })} /></div>
        </div>
      </Card>
      <Card title="Analyses">
        <div className={styles.stack}>
          {table.data && rows > 0 ? <QuestionForm table={table.data} metrics={metrics} deed="Add to the plan" busy={false} planned onAsk={(question) => set({ questions: [...draft.questions, question] })} /> : table.isPending ? <Skeleton height="140px" /> : <p className={styles.muted}>The columns are known once a first trial is scored.</p>}
          <Table caption="Analyses of the plan" rows={draft.questions} keyOf={(_, i) => String(i)} empty="None yet." columns={[
            { name: 'Question', cell: (one) => one.question }, { name: 'Method', cell: (one) => one.method }, { name: 'Formula', cell: (one) => <code>{one.formula}</code> },
            { name: 'Family', cell: (one) => (one.primary ? <Badge tone="accent">primary</Badge> : 'described') },
            { name: <span className="hidden-visually">Decide</span>, cell: (one) => <Button look="quiet" label={`Remove: ${one.question}`} onClick={() => set({ questions: draft.questions.filter((other) => other !== one) })}>Remove</Button> },
          ]} />
        </div>
      </Card>
      <div className={styles.end}><p className={styles.muted} role="status">{'missing' in ready ? ready.missing : ''}</p><Button look="solid" disabled={!('plan' in ready)} onClick={() => setLocking(true)}>Lock the plan…</Button></div>
      {locking && 'plan' in ready ? (
        <AskDialog title="Lock this plan" deed="Lock it" onClose={() => setLocking(false)} onDeed={() => lockPlan(ready.plan, study, seen).then(({ id }) => go(`/analysis/plans/${id}`))}>
          <p>{kLockMeaning}</p>
          <p>{rows === 0 ? 'There is no scored trial yet: the plan comes before its data.' : `${formatCount(rows)} scored trials are there already.`}</p>
          <label className={styles.check}><input type="checkbox" checked={seen} onChange={(event) => setSeen(event.target.checked)} /> I have seen these data: it is a reanalysis</label>
        </AskDialog>
      ) : null}
    </div>
  );
}

const kState: Record<AnalysisRun['state'], 'neutral' | 'accent' | 'good' | 'bad'> = { queued: 'neutral', running: 'accent', done: 'good', failed: 'bad' };

/** A locked plan, every word of it, and what was run by it. */
export function PlanPage({ id }: { readonly id: string }) {
  const client = useQueryClient();
  const [, go] = useLocation();
  const query = useQuery(planQuery(id));
  useTitle(query.data?.title ?? 'Plan');
  const begun = useMutation({ mutationFn: (snapshot: string | undefined) => runPlan(id, snapshot), onSuccess: async (run) => { await client.invalidateQueries({ queryKey: ['cohort', 'plans', id] }); go(`/analysis/runs/${run.id}`); } });
  const back = <p className={styles.back}><Link href="/analysis">← Analysis</Link></p>;
  if (query.isError) return <div className={styles.page}>{back}<Notice tone="bad" title="The plan could not be loaded." onRetry={() => void query.refetch()}>{query.error.message}</Notice></div>;
  if (!query.data) return <div className={styles.page}>{back}<Skeleton width="320px" height="36px" /><Skeleton height="240px" /></div>;
  const plan = query.data;
  const planned = Array.isArray(plan.plan.analyses) ? plan.plan.analyses as { id: string; question?: string; method: string; formula?: string; family?: string }[] : [];
  return (
    <div className={styles.page}>
      {back}
      <div className={styles.head}>
        <div><h1>{plan.title}</h1><p className={styles.lead}>Locked by {plan.made_by}, {formatDateTime(plan.made_utc_us)}, with {formatCount(plan.trials_then)} scored trials there. {plan.data_seen ? 'The data were known: it confirms nothing.' : ''}</p></div>
        <Button look="solid" disabled={begun.isPending} onClick={() => begun.mutate(undefined)}>{begun.isPending ? 'Asking…' : 'Run on the trials of now'}</Button>
      </div>
      {begun.isError ? <Notice tone="bad" title="It was not run.">{begun.error.message}</Notice> : null}
      <Card title="What is asked" aside={<Term align="end" definition={kLockMeaning}>locked</Term>}>
        <Table caption="Planned analyses" rows={planned} keyOf={(one) => one.id} empty="Nothing." columns={[
          { name: 'Question', cell: (one) => one.question ?? one.id }, { name: 'Method', cell: (one) => one.method }, { name: 'Formula', cell: (one) => <code>{one.formula ?? ''}</code> }, { name: 'Family', cell: (one) => one.family ?? 'described' },
        ]} />
      </Card>
      <Card title="Analyses by this plan">
        <Table<AnalysisRun> caption="Analyses, newest first" rows={plan.analyses} keyOf={(one) => one.id} empty="It was not run yet." columns={[
          { name: 'When', cell: (one) => <Link href={`/analysis/runs/${one.id}`}>{formatDateTime(one.made_utc_us)}</Link> },
          { name: 'State', cell: (one) => <Badge tone={kState[one.state]}>{one.state === 'running' ? `at work, ${formatShare(one.share)}` : one.state}</Badge> },
          { name: 'Data', cell: (one) => (one.snapshot === null ? '–' : <code>{one.snapshot.slice(0, 12)}</code>) },
          { name: <span className="hidden-visually">Decide</span>, cell: (one) => (one.snapshot === null ? null : <Button look="quiet" onClick={() => begun.mutate(one.snapshot ?? undefined)}>Again on the same data</Button>) },
        ]} />
      </Card>
    </div>
  );
}
