import { Link } from 'wouter';
import { Card } from '@/ui';
import styles from './guide.module.css';
import python from './scripts/trials.py?raw';
import r from './scripts/trials.R?raw';
import shell from './scripts/trials.sh?raw';

const kExamples = [
  { title: 'curl', code: shell },
  { title: 'Python', code: python },
  { title: 'R', code: r },
] as const;

/** How a person's programs call the server; the examples are files that the tests run. */
export function ScriptsPage() {
  return (
    <>
      <p className={styles.for}>Let your own programs read trials, run analyses and the model lab.</p>
      <Card title="Steps">
        <ol className={styles.steps}>
          <li>
            <strong>Make a token</strong>
            <p>
              Choose a name, the scopes that the program needs, and a date. The token is shown once.{' '}
              <Link href="/account/tokens">API tokens</Link>
            </p>
          </li>
          <li>
            <strong>Send it with every request</strong>
            <p>
              The header is <code>Authorization: Bearer TOKEN</code>. A token acts for you: your role decides what it
              may see, its scopes what it may do. Error 403 names the scope that is missing.
            </p>
          </li>
          <li>
            <strong>Keep it like a password</strong>
            <p>Store it in a file that only you can read, or in an environment variable. Revoke it when it is lost.</p>
          </li>
        </ol>
      </Card>
      {kExamples.map(({ title, code }) => (
        <Card key={title} title={title}>
          {/* eslint-disable-next-line jsx-a11y/no-noninteractive-tabindex -- scrolls by keyboard */}
          <pre className={styles.code} tabIndex={0} aria-label={`Example with ${title}`}>
            {code}
          </pre>
        </Card>
      ))}
      <p>
        Every route with its fields: <a href="/api/openapi.json">description of the API (OpenAPI)</a>
      </p>
    </>
  );
}
