import { useMutation, useQuery, useQueryClient } from '@tanstack/react-query';
import { useState, type FormEvent } from 'react';
import { Link, useLocation, useSearch } from 'wouter';
import {
  addAssignment,
  allCasesQuery,
  kAssignmentLists,
  cohortQuery,
  cohortsQuery,
  kFeltSigns,
  scenariosQuery,
} from '@/api';
import { say, Sentence } from '@/language';
import { Badge, Button, Card, Field, Notice, Select, Skeleton, useTitle } from '@/ui';
import { formatCount, timeZone } from '@/units';
import styles from './assignments.module.css';
import { kNoDraft, firstProblem, toggled, trialsEach, requestOf, type Draft, type Item } from './draft';
import { kDrillThenPalpate, kOrderLabels, kOrderWords, kReleaseLabels, kRigWords } from './labels';

type Change = (change: Partial<Draft>) => void;

/** All that can be assigned; undefined while it is on its way. */
function useItems(): { items: Item[] | undefined; failed: Error | null; retry: () => void } {
  const cases = useQuery(allCasesQuery),
    scenarios = useQuery(scenariosQuery);
  const failed = cases.error ?? scenarios.error;
  const retry = () => {
    void cases.refetch();
    void scenarios.refetch();
  };
  if (!cases.data || !scenarios.data) return { items: undefined, failed, retry };
  const items: Item[] = [
    ...cases.data.cases
      .filter(({ retired }) => !retired)
      .map(({ id, title, planned, felt }) => ({
        key: `case ${id}`,
        title,
        rig: 'palpation' as const,
        case_id: id,
        whole: planned,
        ...(planned || felt === 'told' ? {} : { sign: say(kFeltSigns[felt].text) }),
      })),
    ...scenarios.data.scenarios
      .filter(({ published }) => published)
      .map(({ id, name }) => ({ key: `scenario ${id}`, title: name, rig: 'probing' as const, case_id: id })),
    ...scenarios.data.tuned.map(({ kind, name }) => ({
      key: `tuned ${kind}`,
      title: say('{name} (built-in)', { name }),
      rig: 'probing' as const,
      tuned: kind,
    })),
  ];
  return { items, failed, retry };
}

function CasesField({
  draft,
  items,
  onDraft,
}: {
  readonly draft: Draft;
  readonly items: readonly Item[];
  readonly onDraft: (draft: Draft) => void;
}) {
  return (
    <fieldset className={styles.choices}>
      <legend className="hidden-visually">{say('Cases')}</legend>
      {items.map((item) => {
        const chosen = draft.chosen.find(({ key }) => key === item.key);
        return (
          <div key={item.key} className={styles.choice} data-chosen={chosen !== undefined || undefined}>
            <label>
              <input type="checkbox" checked={chosen !== undefined} onChange={() => onDraft(toggled(draft, item))} />{' '}
              <span>{item.title}</span>
            </label>
            <Badge>{item.whole ? say(kDrillThenPalpate) : say(kRigWords[item.rig])}</Badge>
            {item.sign === undefined ? null : <Badge tone="warn">{item.sign}</Badge>}
            <input
              className={styles.blind}
              aria-label={say('Blind name of {title}', { title: item.title })}
              placeholder={say('blind name')}
              maxLength={128}
              value={chosen?.blind ?? ''}
              disabled={!chosen}
              onChange={(event) =>
                onDraft({
                  ...draft,
                  chosen: draft.chosen.map((one) =>
                    one.key === item.key ? { ...one, blind: event.target.value } : one,
                  ),
                })
              }
            />
          </div>
        );
      })}
    </fieldset>
  );
}

function People({ draft, change }: { readonly draft: Draft; readonly change: Change }) {
  const cohorts = useQuery(cohortsQuery);
  const [from, setFrom] = useState('');
  const source = from || cohorts.data?.cohorts[0]?.id || '';
  const members = useQuery({ ...cohortQuery(source), enabled: source !== '' });
  if (cohorts.isError)
    return (
      <Notice tone="bad" title={say('The cohorts could not be loaded.')} onRetry={() => void cohorts.refetch()}>
        {cohorts.error.message}
      </Notice>
    );
  if (!cohorts.data) return <Skeleton height="180px" />;
  if (cohorts.data.cohorts.length === 0)
    return (
      <p>
        <Sentence
          text="No cohorts yet. <link>Create a cohort</link> and add trainees first."
          parts={{ link: (words) => <Link href="/network/cohorts">{words}</Link> }}
        />
      </p>
    );
  const options = cohorts.data.cohorts.map(({ id, name, trainees }) => ({
    value: id,
    text: say('{name}, {trainees, plural, one {# trainee} other {# trainees}}', { name, trainees }),
  }));
  const trainees = members.data?.people.filter(({ part, state }) => part === 'trainee' && state === 'active') ?? [];
  return (
    <div className={styles.stack}>
      <Select
        label={say('Cohort (includes later members)')}
        value={draft.cohort}
        options={[{ value: '', text: say('none') }, ...options]}
        onChange={(event) => change({ cohort: event.target.value })}
      />
      <Select
        label={say('Individual trainees from')}
        value={source}
        options={options}
        onChange={(event) => setFrom(event.target.value)}
      />
      <fieldset className={styles.people}>
        <legend className="hidden-visually">{say('People')}</legend>
        {members.isPending ? <Skeleton height="28px" /> : null}
        {members.data && trainees.length === 0 ? (
          <p className={styles.muted}>{say('This cohort has no trainees yet.')}</p>
        ) : null}
        {trainees.map(({ name }) => (
          <label key={name} className={styles.person}>
            <input
              type="checkbox"
              checked={draft.people.includes(name) || draft.cohort === source}
              disabled={draft.cohort === source}
              onChange={() =>
                change({
                  people: draft.people.includes(name)
                    ? draft.people.filter((one) => one !== name)
                    : [...draft.people, name],
                })
              }
            />{' '}
            {name}
          </label>
        ))}
      </fieldset>
    </div>
  );
}

/** Cases, trainees, order, due date and release of a new assignment. */
export function NewAssignmentPage() {
  useTitle(say('New assignment'));
  const client = useQueryClient();
  const [, go] = useLocation();
  const wanted = new URLSearchParams(useSearch()).get('case');
  const [written, setDraft] = useState<Draft | null>(null);
  const [now_us] = useState(() => Date.now() * 1000);
  const { items, failed, retry } = useItems();
  const first = wanted === null ? undefined : items?.find(({ case_id }) => case_id === wanted);
  const draft = written ?? (first ? toggled(kNoDraft, first) : kNoDraft);
  const change: Change = (next) => setDraft({ ...draft, ...next });
  const made = useMutation({
    mutationFn: addAssignment,
    onSuccess: async ({ id }) => {
      await client.invalidateQueries({ queryKey: kAssignmentLists });
      go(`/assignments/${id}`);
    },
  });
  const missing = firstProblem(draft, now_us);
  const submit = (event: FormEvent) => {
    event.preventDefault();
    if (missing === '') made.mutate(requestOf(draft));
  };
  return (
    <form className={styles.page} onSubmit={submit}>
      <p>
        <Link href="/assignments">{`← ${say('Assignments')}`}</Link>
      </p>
      <h1>{say('New assignment')}</h1>
      {failed ? (
        <Notice tone="bad" title={say('The cases could not be loaded.')} onRetry={retry}>
          {failed.message}
        </Notice>
      ) : null}
      <div className={styles.two}>
        <Card
          title={say('Cases')}
          aside={
            <span className={styles.muted}>{say('{count} chosen', { count: formatCount(draft.chosen.length) })}</span>
          }
        >
          <div className={styles.stack}>
            <p className={styles.muted}>{say('Trainees see only the blind name, never the title of the case.')}</p>
            {items ? (
              items.length === 0 ? (
                <p>{say('No cases yet.')}</p>
              ) : (
                <CasesField draft={draft} items={items} onDraft={setDraft} />
              )
            ) : (
              <Skeleton height="240px" />
            )}
          </div>
        </Card>
        <Card title={say('Trainees')}>
          <People draft={draft} change={change} />
        </Card>
      </div>
      <Card title={say('Settings')}>
        <div className={styles.form}>
          <Field
            label={say('Title, shown to trainees')}
            value={draft.title}
            required
            maxLength={200}
            placeholder={say('Week 12, palpation')}
            onChange={(event) => change({ title: event.target.value })}
          />
          <Select
            label={say('Order')}
            value={draft.ordering}
            options={Object.keys(kOrderLabels).map((value) => ({ value, text: say(kOrderWords[value] ?? value) }))}
            aria-describedby="order-means"
            onChange={(event) => {
              const to = event.target.value;
              if (to === 'fixed' || to === 'random' || to === 'balanced') change({ ordering: to });
            }}
          />
          <Field
            label={say('Repeats per case')}
            type="number"
            min={1}
            max={20}
            value={draft.repeats}
            onChange={(event) => {
              const n = Number(event.target.value);
              if (Number.isInteger(n) && n >= 1 && n <= 20) change({ repeats: n });
            }}
          />
          <Field
            label={say('Due (optional, {zone})', { zone: timeZone() })}
            type="datetime-local"
            value={draft.due}
            onChange={(event) => change({ due: event.target.value })}
          />
          <Select
            label={say('Results')}
            value={draft.release}
            options={Object.entries(kReleaseLabels).map(([value, { name }]) => ({ value, text: say(name) }))}
            aria-describedby="release-means"
            onChange={(event) => {
              const to = event.target.value;
              if (to === 'held' || to === 'released' || to === 'at_once') change({ release: to });
            }}
          />
          <p id="order-means" className={`${styles.wide} ${styles.muted}`}>
            {say(kOrderLabels[draft.ordering])}.
          </p>
          <p id="release-means" className={`${styles.wide} ${styles.muted}`}>
            {say(kReleaseLabels[draft.release].description)}
          </p>
        </div>
      </Card>
      {made.isError ? (
        <Notice tone="bad" title={say('The assignment was not created.')}>
          {made.error.message}
        </Notice>
      ) : null}
      <div className={styles.go}>
        <span role="status" className={styles.muted}>
          {missing ||
            say('{trials, plural, one {# trial} other {# trials}} for each trainee.', { trials: trialsEach(draft) })}
        </span>
        <Button look="solid" type="submit" disabled={missing !== '' || made.isPending}>
          {made.isPending ? say('Assigning…') : say('Assign')}
        </Button>
      </div>
    </form>
  );
}
