import { useQuery } from '@tanstack/react-query';
import { Link } from 'wouter';
import { sessionQuery } from '@/api';
import { Card, useTitle } from '@/ui';
import styles from './guide.module.css';
import { kPages, type GuidePage as Page } from './pages';
import { ScriptsPage } from './scripts-page';

/** Address of each picture that the tests have made, by its name; a step without one stands alone. */
const kMade = import.meta.glob<string>('./pictures/*.jpg', { eager: true, query: '?url', import: 'default' });
const addressOf = (name: string | undefined) => (name === undefined ? undefined : kMade[`./pictures/${name}.jpg`]);

function RolePage({ page }: { readonly page: Page }) {
  return (
    <>
      <p className={styles.for}>{page.purpose}</p>
      <Card title="Steps">
        <ol className={styles.steps}>
          {page.steps.map(({ title, text, to, picture }) => (
            <li key={title}>
              <strong>{title}</strong>
              <p>
                {text} {to ? <Link href={to.href}>{to.name}</Link> : null}
              </p>
              {picture && addressOf(picture.name) ? (
                <img
                  className={styles.picture}
                  src={addressOf(picture.name)}
                  alt={picture.shows}
                  width={1200}
                  height={750}
                  loading="lazy"
                />
              ) : null}
            </li>
          ))}
        </ol>
      </Card>
      <Card title="Terms">
        <dl className={styles.terms}>
          {page.terms.map(([word, meaning]) => (
            <div key={word}>
              <dt>{word}</dt>
              <dd>{meaning}</dd>
            </div>
          ))}
        </dl>
      </Card>
    </>
  );
}

/** One page for each role: its purpose, steps and terms; and one for scripts. */
export function GuidePage({ role }: { readonly role: string | undefined }) {
  const own = useQuery({ ...sessionQuery, enabled: false }).data?.role;
  const page = kPages.find((one) => one.role === (role ?? own)) ?? kPages[0];
  const scripts = role === 'scripts';
  useTitle(scripts ? 'Guide: Scripts' : page ? `Guide: ${page.name}` : 'Guide');
  if (!page) return null;
  return (
    <div className={styles.page}>
      <div>
        <h1>Guide</h1>
        <p className={styles.lead}>Choose a role:</p>
      </div>
      <nav aria-label="Roles" className={styles.tabs}>
        {kPages.map((one) => (
          <Link
            key={one.role}
            href={`/guide/${one.role}`}
            aria-current={!scripts && one.role === page.role ? 'page' : undefined}
          >
            {one.name}
          </Link>
        ))}
        <Link href="/guide/scripts" aria-current={scripts ? 'page' : undefined}>
          Scripts
        </Link>
      </nav>
      {scripts ? <ScriptsPage /> : <RolePage page={page} />}
    </div>
  );
}
