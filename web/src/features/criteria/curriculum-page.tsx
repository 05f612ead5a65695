import { useMutation, useQuery, useQueryClient } from '@tanstack/react-query';
import { useState } from 'react';
import { Link } from 'wouter';
import {
  cohortsQuery,
  curriculaQuery,
  curriculumProgressQuery,
  giveCurriculum,
  repeatStep,
  type CurriculumPerson,
  type CurriculumVersion,
  type Release,
} from '@/api';
import { say } from '@/language';
import { AskDialog, Badge, Button, Card, DataTable, Notice, Select, Skeleton, useTitle } from '@/ui';
import { formatCount, formatDate, formatDateTime, isoDateTime } from '@/units';
import styles from './criteria.module.css';
import { Requirements, stateText, StepState } from './parts';

function Steps({ of }: { readonly of: CurriculumVersion }) {
  const nameOf = (id: string) => of.steps.find((step) => step.id === id)?.name ?? id;
  return (
    <ol className={styles.steps}>
      {of.steps.map((step) => (
        <li key={step.id}>
          <h3>{step.name}</h3>
          <p className={styles.muted}>
            {step.after.length === 0
              ? say('Open from the start.')
              : say('After: {steps}.', { steps: step.after.map(nameOf).join(', ') })}{' '}
            {say('{repeats, plural, one {# planned trial} other {# planned trials}} of each of {cases}.', {
              repeats: step.repeats,
              cases: step.cases.map(({ title }) => title).join(', '),
            })}
          </p>
          <Requirements of={step.requirements} />
        </li>
      ))}
    </ol>
  );
}

/** One line a person, as a file for a spreadsheet. */
function csvOf(people: readonly CurriculumPerson[]): string {
  const quoted = (text: string) => `"${text.replaceAll('"', '""')}"`;
  const steps = [...new Set(people.flatMap((one) => one.steps.map(({ name }) => name)))];
  const lines = people.map((one) => {
    const cells = steps.map((name) => {
      const step = one.steps.find((other) => other.name === name);
      return step ? stateText(step.state) : '';
    });
    const since = one.passed_utc_us === null ? '' : isoDateTime(one.passed_utc_us);
    return [quoted(one.name), String(one.version), one.passed ? 'yes' : 'no', since, ...cells.map(quoted)].join(',');
  });
  return [['name', 'version', 'passed', 'passed_utc', ...steps.map(quoted)].join(','), ...lines, ''].join('\n');
}

function save(name: string, text: string): void {
  const link = document.createElement('a');
  link.href = URL.createObjectURL(new Blob([text], { type: 'text/csv' }));
  link.download = name;
  link.click();
  URL.revokeObjectURL(link.href);
}

function Give({ id }: { readonly id: string }) {
  const client = useQueryClient();
  const cohorts = useQuery(cohortsQuery).data?.cohorts ?? [];
  const [cohort, setCohort] = useState('');
  const [release, setRelease] = useState<Release>('at_once');
  const given = useMutation({
    mutationFn: () => giveCurriculum(id, cohort, release, null),
    onSuccess: async (people) => {
      client.setQueryData(curriculumProgressQuery(id).queryKey, people);
      await client.invalidateQueries({ queryKey: ['assignments'] });
    },
  });
  return (
    <Card title={say('Give to a cohort')}>
      <div className={styles.stack}>
        <Select
          label={say('Cohort')}
          value={cohort}
          onChange={(event) => setCohort(event.target.value)}
          options={[
            { value: '', text: say('Choose a cohort') },
            ...cohorts.map(({ id: value, name }) => ({ value, text: name })),
          ]}
        />
        <Select
          label={say('Trainees see their results')}
          value={release}
          onChange={(event) => setRelease(event.target.value as Release)}
          options={[
            { value: 'at_once', text: say('as soon as a trial is uploaded') },
            { value: 'held', text: say('not until they are released') },
          ]}
        />
        <p className={styles.muted}>
          {say(
            'Makes an assignment of each step. A trainee who joins the cohort later gets the newest version that the cohort was given.',
          )}
        </p>
        {given.isError ? (
          <Notice tone="bad" title={say('The curriculum was not given.')}>
            {given.error.message}
          </Notice>
        ) : null}
        {given.isSuccess ? <p role="status">{say('Given to the cohort.')}</p> : null}
        <Button disabled={cohort === '' || given.isPending} onClick={() => given.mutate()}>
          {say('Give')}
        </Button>
      </div>
    </Card>
  );
}

function People({ id, people }: { readonly id: string; readonly people: readonly CurriculumPerson[] | undefined }) {
  const client = useQueryClient();
  const [again, setAgain] = useState<{ person: CurriculumPerson; step: string; name: string } | null>(null);
  const passed = (one: CurriculumPerson) => one.steps.filter(({ state }) => state === 'passed').length;
  return (
    <Card
      title={say('People')}
      aside={
        people && people.length > 0 ? (
          <Button onClick={() => save('curriculum.csv', csvOf(people))}>{say('CSV')}</Button>
        ) : undefined
      }
    >
      <DataTable<CurriculumPerson>
        address=""
        caption={say('People')}
        minWidth={680}
        rows={people}
        keyOf={(one) => `${one.account_id} ${one.version}`}
        empty={say('Nobody has this curriculum yet.')}
        filter={{ label: say('Filter by name'), text: ({ name }) => name }}
        columns={[
          {
            name: say('Name'),
            by: ({ name }) => name,
            cell: ({ name, simulated }) => (
              <>
                <Link href={`/trainees/${encodeURIComponent(name)}`}>{name}</Link>{' '}
                {simulated ? <Badge tone="warn">{say('simulated')}</Badge> : null}
              </>
            ),
          },
          {
            name: say('Version'),
            by: ({ version }) => version,
            cell: ({ version }) => formatCount(version),
            number: true,
          },
          {
            name: say('Steps'),
            by: passed,
            cell: (person) => (
              <ul className={styles.states}>
                {person.steps.map((step) => (
                  <li key={step.id}>
                    {step.name} <StepState state={step.state} />{' '}
                    <span className={styles.muted}>
                      {say('{done} of {planned}', { done: formatCount(step.done), planned: formatCount(step.planned) })}
                    </span>
                    {step.state === 'used_up' ? (
                      <Button
                        look="quiet"
                        label={say('Assign {step} again to {name}', { step: step.name, name: person.name })}
                        onClick={() => setAgain({ person, step: step.id, name: step.name })}
                      >
                        {say('Assign again…')}
                      </Button>
                    ) : null}
                  </li>
                ))}
              </ul>
            ),
          },
          { name: say('Next case'), by: ({ next }) => next?.case, cell: ({ next }) => next?.case ?? '–' },
          {
            name: say('Certificate'),
            by: ({ passed_utc_us }) => passed_utc_us,
            cell: (one) =>
              one.passed && one.passed_utc_us !== null ? (
                <Link href={`/certificates/${one.account_id}/${one.curriculum_id}`}>
                  {say('passed {date}', { date: formatDate(one.passed_utc_us) })}
                </Link>
              ) : (
                '–'
              ),
          },
        ]}
      />
      {again ? (
        <AskDialog
          title={say('Assign {step} again to {name}?', { step: again.name, name: again.person.name })}
          action={say('Assign again')}
          onClose={() => setAgain(null)}
          onAction={() =>
            repeatStep(id, again.person.account_id, again.step).then((next) =>
              client.setQueryData(curriculumProgressQuery(id).queryKey, next),
            )
          }
        >
          <p>{say('The planned trials of the step are assigned once more. All trials of the step count together.')}</p>
        </AskDialog>
      ) : null}
    </Card>
  );
}

/** One curriculum: its steps, and where everybody stands. */
export function CurriculumPage({ id }: { readonly id: string }) {
  const query = useQuery(curriculaQuery);
  const progress = useQuery(curriculumProgressQuery(id));
  const one = query.data?.curricula.find((other) => other.id === id);
  const newest = one?.versions.at(-1);
  useTitle(newest?.title ?? say('Curriculum'));
  const failed = query.error ?? progress.error;
  return (
    <div className={styles.page}>
      <p>
        <Link href="/curricula">← {say('Curricula')}</Link>
      </p>
      {failed ? (
        <Notice
          tone="bad"
          title={say('The curriculum could not be loaded.')}
          onRetry={() => {
            void query.refetch();
            void progress.refetch();
          }}
        >
          {failed.message}
        </Notice>
      ) : null}
      {query.data && !one ? <Notice tone="bad" title={say('There is no such curriculum.')} /> : null}
      {query.isPending ? <Skeleton height="320px" /> : null}
      {newest ? (
        <>
          <div className={styles.top}>
            <div>
              <h1>{newest.title}</h1>
              <p className={styles.lead}>
                {say('Version {version}, {time} by {name}', {
                  version: formatCount(newest.version),
                  time: formatDateTime(newest.made_utc_us),
                  name: newest.made_by,
                })}
                {newest.reason === '' ? '' : `: ${newest.reason}`}
              </p>
            </div>
            <Link href={`/curricula/${id}/edit`} className={styles.solid}>
              {say('Change…')}
            </Link>
          </div>
          <People id={id} people={progress.data?.people} />
          <div className={styles.two}>
            <Card title={say('Steps')}>
              <Steps of={newest} />
            </Card>
            <Give id={id} />
          </div>
        </>
      ) : null}
    </div>
  );
}
