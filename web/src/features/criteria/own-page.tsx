import { useQuery } from '@tanstack/react-query';
import { Link } from 'wouter';
import { ownCurriculaQuery, sessionQuery, type CurriculumPerson } from '@/api';
import { say, Sentence } from '@/language';
import { Card, Notice, Skeleton, useTitle } from '@/ui';
import { formatCount } from '@/units';
import styles from './criteria.module.css';
import { Judged, StepState } from './parts';

function Mine({ of }: { readonly of: CurriculumPerson }) {
  const next = of.steps.find(({ id }) => id === of.next?.step);
  return (
    <Card title={of.title}>
      <div className={styles.stack}>
        {of.passed ? (
          <p>
            {say('You have passed.')}{' '}
            <Link href={`/certificates/${of.account_id}/${of.curriculum_id}`}>{say('Certificate')}</Link>
          </p>
        ) : next ? (
          <p>
            <Sentence
              text="Your next step: <strong>{name}</strong>. A station offers its trials after badge and PIN."
              values={{ name: next.name }}
              parts={{ strong: (words) => <strong>{words}</strong> }}
            />
          </p>
        ) : null}
        <ol className={styles.steps}>
          {of.steps.map((step) => (
            <li key={step.id}>
              <h3>
                {step.name} <StepState state={step.state} />
              </h3>
              <p className={styles.muted}>
                {say('{done} of {planned} planned trials done', {
                  done: formatCount(step.done),
                  planned: formatCount(step.planned),
                })}
              </p>
              <Judged of={step.requirements} />
            </li>
          ))}
        </ol>
      </div>
    </Card>
  );
}

/** A trainee's own curricula. */
export function OwnCurriculaPage() {
  useTitle(say('My curriculum'));
  const session = useQuery({ ...sessionQuery, enabled: false }).data;
  const query = useQuery({ ...ownCurriculaQuery(session?.id ?? ''), enabled: session?.id !== undefined });
  return (
    <div className={styles.page}>
      <div>
        <h1>{say('My curriculum')}</h1>
        <p className={styles.lead}>{say('The steps of your training, and the criteria of each.')}</p>
      </div>
      {query.isError ? (
        <Notice tone="bad" title={say('Your curriculum could not be loaded.')} onRetry={() => void query.refetch()}>
          {query.error.message}
        </Notice>
      ) : null}
      {query.isPending ? <Skeleton height="240px" /> : null}
      {query.data?.people.length === 0 ? (
        <Notice title={say('No curriculum yet.')}>
          {say('Your faculty has not given you a curriculum. Your assignments are under “My work”.')}
        </Notice>
      ) : null}
      {query.data?.people.map((one) => (
        <Mine key={`${one.curriculum_id} ${one.version}`} of={one} />
      ))}
    </div>
  );
}
