import { useQuery } from '@tanstack/react-query';
import { Link } from 'wouter';
import { ownCurriculaQuery, sessionQuery, type CurriculumPerson } from '@/api';
import { say, Sentence } from '@/language';
import { Button, Notice, Skeleton, useTitle } from '@/ui';
import { formatCount, formatDate } from '@/units';
import styles from './criteria.module.css';
import { Judged } from './parts';

const kDigest_characters = 16;

function Sheet({ of }: { readonly of: CurriculumPerson }) {
  const trials = of.steps.reduce((sum, step) => sum + step.rests_on.trials, 0);
  return (
    <article className={styles.certificate} data-part="certificate">
      <p className={styles.muted}>{say('Tractus · simulated pedicle-screw training')}</p>
      <h1>{say('Certificate')}</h1>
      <p className={styles.holder}>{of.name}</p>
      <p>
        <Sentence
          text="has passed the curriculum <strong>{title}</strong> (version {version}) on {date}."
          values={{
            title: of.title,
            version: formatCount(of.version),
            date: of.passed_utc_us === null ? '–' : formatDate(of.passed_utc_us),
          }}
          parts={{ strong: (words) => <strong>{words}</strong> }}
        />
      </p>
      {of.simulated ? (
        <p className={styles.simulated}>{say('Some of these trials were done by a simulated hand.')}</p>
      ) : null}
      <h2>{say('Evidence')}</h2>
      <ol className={styles.steps}>
        {of.steps.map(({ id, name, requirements, rests_on }) => (
          <li key={id}>
            <h3>{name}</h3>
            <Judged of={requirements} />
            <p className={styles.muted}>
              {rests_on.first_utc_us === null || rests_on.last_utc_us === null
                ? say('{trials, plural, one {# trial} other {# trials}}', { trials: rests_on.trials })
                : say('{trials, plural, one {# trial} other {# trials}}, {first} to {last}', {
                    trials: rests_on.trials,
                    first: formatDate(rests_on.first_utc_us),
                    last: formatDate(rests_on.last_utc_us),
                  })}
              {rests_on.digest === ''
                ? ''
                : `; ${say('digest {digest}', { digest: rests_on.digest.slice(0, kDigest_characters) })}`}
            </p>
          </li>
        ))}
      </ol>
      <p className={styles.muted}>
        {say(
          '{trials} trials on a simulator. Passing says that these requirements were met on these trials; it says nothing of operations on patients. The digest is the beginning of the SHA-256 of the trials’ ids, by which the server’s records can be found.',
          { trials: formatCount(trials) },
        )}
      </p>
      <div className={styles.signatures}>
        <p>{say('Programme director')}</p>
        <p>{say('Date')}</p>
      </div>
    </article>
  );
}

/** What somebody passed, on one sheet, with what it rests on. */
export function CertificatePage({ account, curriculum }: { readonly account: string; readonly curriculum: string }) {
  useTitle(say('Certificate'));
  const query = useQuery(ownCurriculaQuery(account));
  const role = useQuery({ ...sessionQuery, enabled: false }).data?.role;
  const of = query.data?.people.filter((one) => one.curriculum_id === curriculum).at(-1);
  return (
    <div className={styles.page}>
      <div className={`${styles.top} ${styles.screen}`}>
        <Link href={role === 'trainee' ? '/curriculum' : `/curricula/${curriculum}`}>← {say('Curriculum')}</Link>
        {of?.passed ? (
          <Button look="solid" onClick={() => window.print()}>
            {say('Print')}
          </Button>
        ) : null}
      </div>
      {query.isPending || of?.passed ? null : <h1>{say('Certificate')}</h1>}
      {query.isError ? (
        <Notice tone="bad" title={say('The certificate could not be loaded.')} onRetry={() => void query.refetch()}>
          {query.error.message}
        </Notice>
      ) : null}
      {query.isPending ? <Skeleton height="480px" /> : null}
      {query.data && !of?.passed ? (
        <Notice title={say('There is no certificate yet.')}>
          {of
            ? say('{name} has not passed every step of {title}.', { name: of.name, title: of.title })
            : say('The person is not in this curriculum.')}
        </Notice>
      ) : null}
      {of?.passed ? <Sheet of={of} /> : null}
    </div>
  );
}
