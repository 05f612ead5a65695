import { useQuery } from '@tanstack/react-query';
import { Link } from 'wouter';
import { ownCurriculaQuery, sessionQuery, type CurriculumPerson } from '@/api';
import { Button, Notice, Skeleton, useTitle } from '@/ui';
import { formatCount, formatDate } from '@/units';
import styles from './criteria.module.css';
import { Judged } from './parts';

const kDigest_characters = 16;

function Sheet({ of }: { readonly of: CurriculumPerson }) {
  const trials = of.steps.reduce((sum, step) => sum + step.rests_on.trials, 0);
  return (
    <article className={styles.certificate} data-part="certificate">
      <p className={styles.muted}>Tractus · simulated pedicle-screw training</p>
      <h1>Certificate</h1>
      <p className={styles.holder}>{of.name}</p>
      <p>
        has passed the curriculum <strong>{of.title}</strong> (version {formatCount(of.version)}) on{' '}
        {of.passed_utc_us === null ? '–' : formatDate(of.passed_utc_us)}.
      </p>
      {of.simulated ? <p className={styles.simulated}>Some of these trials were done by a simulated hand.</p> : null}
      <h2>Evidence</h2>
      <ol className={styles.steps}>
        {of.steps.map(({ id, name, requirements, rests_on }) => (
          <li key={id}>
            <h3>{name}</h3>
            <Judged of={requirements} />
            <p className={styles.muted}>
              {formatCount(rests_on.trials)} {rests_on.trials === 1 ? 'trial' : 'trials'}
              {rests_on.first_utc_us === null || rests_on.last_utc_us === null
                ? ''
                : `, ${formatDate(rests_on.first_utc_us)} to ${formatDate(rests_on.last_utc_us)}`}
              {rests_on.digest === '' ? '' : `; digest ${rests_on.digest.slice(0, kDigest_characters)}`}
            </p>
          </li>
        ))}
      </ol>
      <p className={styles.muted}>
        {formatCount(trials)} trials on a simulator. Passing says that these requirements were met on these trials; it
        says nothing of operations on patients. The digest is the beginning of the SHA-256 of the trials’ ids, by which
        the server’s records can be found.
      </p>
      <div className={styles.signatures}>
        <p>Programme director</p>
        <p>Date</p>
      </div>
    </article>
  );
}

/** What somebody passed, on one sheet, with what it rests on. */
export function CertificatePage({ account, curriculum }: { readonly account: string; readonly curriculum: string }) {
  useTitle('Certificate');
  const query = useQuery(ownCurriculaQuery(account));
  const role = useQuery({ ...sessionQuery, enabled: false }).data?.role;
  const of = query.data?.people.filter((one) => one.curriculum_id === curriculum).at(-1);
  return (
    <div className={styles.page}>
      <div className={`${styles.top} ${styles.screen}`}>
        <Link href={role === 'trainee' ? '/curriculum' : `/curricula/${curriculum}`}>← Curriculum</Link>
        {of?.passed ? (
          <Button look="solid" onClick={() => window.print()}>
            Print
          </Button>
        ) : null}
      </div>
      {query.isError ? (
        <Notice tone="bad" title="The certificate could not be loaded." onRetry={() => void query.refetch()}>
          {query.error.message}
        </Notice>
      ) : null}
      {query.isPending ? <Skeleton height="480px" /> : null}
      {query.data && !of?.passed ? (
        <Notice title="There is no certificate yet.">
          {of ? `${of.name} has not passed every step of ${of.title}.` : 'The person is not in this curriculum.'}
        </Notice>
      ) : null}
      {of?.passed ? <Sheet of={of} /> : null}
    </div>
  );
}
