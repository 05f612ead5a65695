import { Link } from 'wouter';
import { say, Sentence } from '@/language';
import { Card } from '@/ui';
import { Figures } from './figures';
import styles from './guide.module.css';
import python from './scripts/trials.py?raw';
import r from './scripts/trials.R?raw';
import shell from './scripts/trials.sh?raw';

const kExamples = [
  { title: 'curl', code: shell },
  { title: 'Python', code: python },
  { title: 'R', code: r },
] as const;

/** Addresses of the notebooks, which the tests run. */
const kNotebooks = Object.entries(
  import.meta.glob<string>('../../../../deploy/clients/notebooks/*', { eager: true, query: '?url', import: 'default' }),
).map(([path, href]) => ({ file: path.slice(path.lastIndexOf('/') + 1), href }));

/** How a person's programs call the server; the examples are files that the tests run. */
export function ScriptsPage() {
  return (
    <>
      <p className={styles.for}>{say('Let your own programs read trials, run analyses and the model lab.')}</p>
      <Card title={say('Steps')}>
        <ol className={styles.steps}>
          <li>
            <strong>{say('Make a token')}</strong>
            <p>
              {say('Choose a name, the scopes that the program needs, and a date. The token is shown once.')}{' '}
              <Link href="/account/tokens">{say('API tokens')}</Link>
            </p>
          </li>
          <li>
            <strong>{say('Send it with every request')}</strong>
            <p>
              <Sentence
                text="The header is <code>Authorization: Bearer TOKEN</code>. A token acts for you: your role decides what it may see, its scopes what it may do. Error 403 names the scope that is missing."
                parts={{ code: (words) => <code>{words}</code> }}
              />
            </p>
          </li>
          <li>
            <strong>{say('Keep it like a password')}</strong>
            <p>
              {say(
                'Store it in a file that only you can read, or in an environment variable. Revoke it when it is lost.',
              )}
            </p>
          </li>
        </ol>
      </Card>
      {kExamples.map(({ title, code }) => (
        <Card key={title} title={title}>
          {/* eslint-disable-next-line jsx-a11y/no-noninteractive-tabindex -- scrolls by keyboard */}
          <pre className={styles.code} tabIndex={0} aria-label={say('Example with {title}', { title })}>
            {code}
          </pre>
        </Card>
      ))}
      <Card title={say('Notebooks')}>
        <p>
          <Sentence
            text="Both read a study’s trials from the server and make its table. They need <code>TRACTUS_URL</code>, <code>TRACTUS_TOKEN</code> and the package for Python or R in <code>deploy/clients</code>."
            parts={{ code: (words) => <code>{words}</code> }}
          />
        </p>
        <ul className={styles.steps}>
          {kNotebooks.map(({ file, href }) => (
            <li key={file}>
              <a href={href} download={file}>
                {file}
              </a>
            </li>
          ))}
        </ul>
      </Card>
      <Figures />
      <p>
        <Sentence
          text="Every route with its fields: <link>description of the API (OpenAPI)</link>"
          parts={{ link: (words) => <a href="/api/openapi.json">{words}</a> }}
        />
      </p>
    </>
  );
}
