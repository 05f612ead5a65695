import { useQuery } from '@tanstack/react-query';
import { Link } from 'wouter';
import { sessionQuery } from '@/api';
import { marked, say } from '@/language';
import { Card, useTitle } from '@/ui';
import styles from './guide.module.css';
import { kPages, type GuidePage as Page } from './pages';
import { FirstWeekPage } from './first-week-page';
import { ScriptsPage } from './scripts-page';
import { Steps } from './steps';

/** Pages beside those of the roles. */
const kMore = [
  { at: 'first-week', name: marked('First week'), Content: FirstWeekPage },
  { at: 'scripts', name: marked('Scripts'), Content: ScriptsPage },
] as const;

function RolePage({ page }: { readonly page: Page }) {
  return (
    <>
      <p className={styles.for}>{say(page.purpose)}</p>
      <Card title={say('Steps')}>
        <Steps of={page.steps} />
      </Card>
      <Card title={say('Terms')}>
        <dl className={styles.terms}>
          {page.terms.map(([word, meaning]) => (
            <div key={word}>
              <dt>{say(word)}</dt>
              <dd>{say(meaning)}</dd>
            </div>
          ))}
        </dl>
      </Card>
    </>
  );
}

/** One page for each role: its purpose, steps and terms; the first week of a residency; and one for scripts. */
export function GuidePage({ role }: { readonly role: string | undefined }) {
  const own = useQuery({ ...sessionQuery, enabled: false }).data?.role;
  const page = kPages.find((one) => one.role === (role ?? own)) ?? kPages[0];
  const more = kMore.find(({ at }) => at === role);
  const title = more?.name ?? page?.name;
  useTitle(title === undefined ? say('Guide') : say('Guide: {title}', { title: say(title) }));
  if (!page) return null;
  return (
    <div className={styles.page}>
      <div>
        <h1>{say('Guide')}</h1>
        <p className={styles.lead}>{say('Choose a role:')}</p>
      </div>
      <nav aria-label={say('Roles')} className={styles.tabs}>
        {kPages.map((one) => (
          <Link
            key={one.role}
            href={`/guide/${one.role}`}
            aria-current={!more && one.role === page.role ? 'page' : undefined}
          >
            {say(one.name)}
          </Link>
        ))}
        {kMore.map(({ at, name }) => (
          <Link key={at} href={`/guide/${at}`} aria-current={more?.at === at ? 'page' : undefined}>
            {say(name)}
          </Link>
        ))}
      </nav>
      {more ? <more.Content /> : <RolePage page={page} />}
    </div>
  );
}
